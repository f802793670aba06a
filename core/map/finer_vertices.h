#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "core/geometry/position.h"

namespace fleetplan::core {

/// The vertices that refine a lattice for robots of one radius, where the way past the obstacles is too
/// narrow for it, and their links. Their ids follow those of the lattice.
class FinerVertices {
 public:
  /// From a vertex to another one, both of the lattice or finer ones.
  using Link = std::pair<int, int>;

  /// No vertices.
  FinerVertices() = default;
  /// `first`: the id of the first one, after those of the lattice. `links` in one direction or both.
  FinerVertices(int first, std::vector<Position> positions, std::vector<Link> links);

  int count() const { return static_cast<int>(positions_.size()); }
  int first() const { return first_; }
  const Position& position(int vertex) const { return positions_[static_cast<std::size_t>(vertex - first_)]; }
  /// From a vertex, by their ends.
  std::span<const Link> links_from(int vertex) const;
  /// All links, in both directions.
  std::span<const Link> links() const { return links_; }
  std::size_t bytes() const {
    return positions_.capacity() * sizeof(Position) + links_.capacity() * sizeof(Link) +
           blocks_.capacity() * sizeof(std::int32_t) + by_x_.capacity() * sizeof(int);
  }
  /// Finer vertices within `distance` metres of a position, ascending.
  std::vector<int> near(const Position& position, double distance) const;

 private:
  static std::size_t block_of(int vertex) { return static_cast<std::size_t>(vertex) / 64; }

  int first_ = 0;
  std::vector<Position> positions_;
  std::vector<Link> links_;           // ascending
  std::vector<std::int32_t> blocks_;  // where the links of 64 vertices begin
  std::vector<int> by_x_;             // vertices
};

}  // namespace fleetplan::core
