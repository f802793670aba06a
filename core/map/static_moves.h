#pragma once

#include <cstdint>

#include "core/map/lattice.h"
#include "core/map/line_of_sight.h"
#include "core/map/paged_array.h"

namespace fleetplan::core {

/// The lattice moves that obstacles allow a disk of one radius; computed on first use. Not thread-safe.
class StaticMoves {
 public:
  StaticMoves(const Lattice& lattice, const LineOfSight& sight, double radius);

  /// Bit k is set if step k of the lattice from `vertex` is free of obstacles.
  std::uint32_t from(int vertex);

 private:
  struct Mask {
    std::uint32_t steps = 0;
    bool known = false;
  };

  const Lattice& lattice_;
  const LineOfSight& sight_;
  double radius_;
  PagedArray<Mask> masks_;
};

}  // namespace fleetplan::core
