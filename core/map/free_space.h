#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/geometry/position.h"
#include "core/map/finer_vertices.h"
#include "core/map/lattice.h"
#include "core/map/line_of_sight.h"
#include "core/map/paged_array.h"

namespace fleetplan::core {

/// Where robots of one radius may stand and move, without regard to other robots. Their lattice moves are
/// computed on first use. Not thread-safe.
class FreeSpace {
 public:
  /// `finer`: null if the lattice is not refined.
  FreeSpace(const Lattice& lattice, const LineOfSight& sight, double radius,
            std::shared_ptr<const FinerVertices> finer = nullptr);

  /// Returns whether the robot may stand at `center` as a disk of this radius (metres).
  bool disk_fits(const Position& center, double radius) const { return sight_.disk_fits(center, radius); }
  /// Returns whether the robot may sweep the segment as a disk of this radius, in this direction.
  bool may_sweep(const Position& from, const Position& to, double radius) const {
    return sight_.may_sweep(from, to, radius);
  }

  /// Whether there are blocked polygons.
  bool among_polygons() const { return !sight_.polygons().empty(); }

  /// The vertices that refine the lattice; may be none.
  const FinerVertices& finer() const { return *finer_; }

  /// Bit k is set if step k of the lattice from `vertex` is free.
  std::uint32_t steps_from(int vertex);

 private:
  struct Mask {
    std::uint32_t steps = 0;
    bool known = false;
  };

  const Lattice& lattice_;
  const LineOfSight& sight_;
  double radius_;
  std::shared_ptr<const FinerVertices> finer_;
  double longest_step_ = 0.0;    // metres
  std::uint32_t all_steps_ = 0;  // bits
  PagedArray<Mask> masks_;
};

}  // namespace fleetplan::core
