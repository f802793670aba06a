#pragma once

// Where robots of one radius may stand and move: vertices beside those of the lattice, and free moves.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "core/geometry/position.h"
#include "core/map/lattice.h"
#include "core/map/line_of_sight.h"
#include "core/runtime/arrays.h"

namespace fleetplan::core {

/// The vertices that refine a lattice for robots of one radius, where the way past the obstacles is too
/// narrow for the lattice, and their links. Their ids follow those of the lattice.
class FinerVertices {
 public:
  /// A link from a vertex to another one; both may be vertices of the lattice or finer ones.
  using Link = std::pair<int, int>;

  /// No vertices.
  FinerVertices() = default;
  /// `first` is the id of the first finer vertex, after those of the lattice. `links` may be given in one
  /// direction or in both.
  FinerVertices(int first, std::vector<Position> positions, std::vector<Link> links);

  int count() const { return static_cast<int>(positions_.size()); }
  int first() const { return first_; }
  const Position& position(int vertex) const { return positions_[static_cast<std::size_t>(vertex - first_)]; }
  /// Returns the links from a vertex, by their ends.
  std::span<const Link> links_from(int vertex) const;
  /// All links, in both directions.
  std::span<const Link> links() const { return links_; }
  std::size_t bytes() const {
    return positions_.capacity() * sizeof(Position) + links_.capacity() * sizeof(Link) +
           blocks_.capacity() * sizeof(std::int32_t) + by_x_.capacity() * sizeof(int);
  }
  /// Returns the finer vertices within `distance` metres of a position, ascending.
  std::vector<int> near(const Position& position, double distance) const;

 private:
  static std::size_t block_of(int vertex) { return static_cast<std::size_t>(vertex) / 64; }

  int first_ = 0;
  std::vector<Position> positions_;
  std::vector<Link> links_;           // ascending
  std::vector<std::int32_t> blocks_;  // begin of the links of each 64 vertices
  std::vector<int> by_x_;             // vertices by x
};

/// Where robots of one radius may stand and move, without regard to other robots. Their lattice moves are
/// computed on first use. Not thread-safe.
class FreeSpace {
 public:
  /// The free space for robots of `radius` metres. `finer`: null if the lattice is not refined.
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

  /// The vertices that refine the lattice; there may be none.
  const FinerVertices& finer() const { return *finer_; }

  /// Returns the free steps of the lattice from `vertex`: bit k is set if step k is free.
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
