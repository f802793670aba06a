#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <numbers>
#include <span>
#include <vector>

#include "core/geometry/position.h"

namespace fleetplan::core {

class OccupancyGrid;

/// The heading and the length (metres) of the straight line from one position to another; heading 0 if the
/// length is 0.
struct Displacement {
  double heading = 0.0;
  double length = 0.0;

  /// Returns the displacement between any two positions.
  static Displacement between(const Position& from, const Position& to);
};

/// The vertices at which robots may stop: the centres of squares as large as the spacing, counted from the
/// lower left of the map and numbered row by row. Those of the map's resolution are the cells. Which of them
/// are blocked is not part of the lattice (see LineOfSight).
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
  /// The least length of a straight line as a share of the lattice moves between its ends, without obstacles:
  /// the cosine of half the angle between neighbouring moves.
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
  // Headings and lengths of displacements by fewer columns and rows than these; by row, then column.
  int table_columns_;
  int table_rows_;
  std::vector<Displacement> first_quadrant_;
};

/// Metres between the vertices of the lattice for a robot of this radius: the map's resolution; where that is
/// at most a quarter of the radius, its largest odd multiple up to this radius, so that vertices are centres
/// of cells as well.
double default_lattice_spacing(const OccupancyGrid& grid, double radius);

}  // namespace fleetplan::core
