#pragma once

// Where robots may stop and move on the map, without regard to other robots:
//
// - the lattice,
// - the vertices that refine it,
// - and the free moves of robots of one radius.

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

#include "core/geometry/position.h"
#include "core/map/line_of_sight.h"
#include "core/map/occupancy_grid.h"
#include "core/runtime/arrays.h"

namespace fleetplan::core {

/// The heading and the length (metres) of the straight line from one position to another; heading 0 if the
/// length is 0.
struct Displacement {
  double heading = 0.0;
  double length = 0.0;

  /// Returns the displacement between any two positions.
  static Displacement between(const Position& from, const Position& to);
};

/// The vertices at which robots may stop. They are the centres of squares whose side is the spacing, counted
/// from the lower left of the map and numbered row by row. If the spacing is the map's resolution, the
/// squares are the cells. The lattice does not know which vertices are blocked (see LineOfSight).
class Lattice {
 public:
  /// One lattice move.
  struct Step {
    int columns;
    int rows;
  };

  /// The lattice of the cells. `connectivity` is 4, 8, 16 or 32: the moves of the 2^k neighbourhood (Rivera,
  /// Hernandez, Baier, AAAI 2017).
  Lattice(const OccupancyGrid& grid, int connectivity);
  /// A lattice with `spacing` metres between its vertices: > 0, and at most twice the width and the height of
  /// the map.
  Lattice(const OccupancyGrid& grid, int connectivity, double spacing);

  /// Returns the number of vertices along a side of the map of `length` metres.
  static std::int64_t vertices_along(double length, double spacing);

  int columns() const { return columns_; }
  int rows() const { return rows_; }
  double spacing() const { return spacing_; }
  int vertex_count() const { return columns_ * rows_; }
  std::span<const Step> steps() const { return steps_; }
  /// The least ratio of a straight line's length to the lattice moves between its ends, without obstacles. It
  /// is the cosine of half the angle between neighbouring moves.
  double least_straight() const { return least_straight_; }

  Position position(int vertex) const {
    const int column = vertex % columns_;
    const int row = vertex / columns_;
    return {(column + 0.5) * spacing_, (row + 0.5) * spacing_};
  }
  int vertex(int column, int row) const { return row * columns_ + column; }
  /// Returns the displacement from one vertex to another.
  Displacement between(int from, int to) const {
    const int columns = to % columns_ - from % columns_;
    const int rows = to / columns_ - from / columns_;
    const int c = std::abs(columns);
    const int r = std::abs(rows);
    if (c >= table_columns_ || r >= table_rows_) return displacement(columns, rows);
    const auto row_begin = static_cast<std::size_t>(r) * static_cast<std::size_t>(table_columns_);
    Displacement d = first_quadrant_[row_begin + static_cast<std::size_t>(c)];
    if (columns < 0) d.heading = std::numbers::pi - d.heading;
    if (rows < 0) d.heading = -d.heading;
    return d;
  }
  /// Returns the vertex within kSamePosition of a position, or -1.
  int vertex_at(const Position& position) const;
  /// Returns the position of the vertex at a position, or the position itself if there is none.
  Position snapped(const Position& position) const {
    const int vertex = vertex_at(position);
    return vertex >= 0 ? this->position(vertex) : position;
  }
  /// Returns the vertices within `distance` metres of a position, ascending.
  std::vector<int> vertices_near(const Position& position, double distance) const;

 private:
  Displacement displacement(int columns, int rows) const;

  int columns_;
  int rows_;
  double spacing_;
  std::vector<Step> steps_;
  double least_straight_;
  // A table has the headings and lengths of displacements by fewer columns and rows than these. By row, then
  // column.
  int table_columns_;
  int table_rows_;
  std::vector<Displacement> first_quadrant_;
};

/// Returns the default spacing of the lattice for a robot of this radius, metres. It is the map's resolution
/// r, unless r is at most a quarter of the radius. Then it is the largest odd multiple of r up to the radius,
/// so that vertices are still centres of cells.
double default_lattice_spacing(const OccupancyGrid& grid, double radius);

/// The vertices and links that refine a lattice for robots of one radius, where the way past obstacles is too
/// narrow for the lattice. Their ids follow the ids of the lattice.
class FinerVertices {
 public:
  /// A link from one vertex to another. Each may be a vertex of the lattice or a finer vertex.
  using Link = std::pair<int, int>;

  /// No vertices.
  FinerVertices() = default;
  /// `first` is the id of the first finer vertex, after the ids of the lattice. `links` may be given in one
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
