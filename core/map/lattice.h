#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <numbers>
#include <span>
#include <vector>

#include "core/map/line_of_sight.h"
#include "core/map/occupancy_grid.h"
#include "core/map/paged_array.h"

namespace fleetplan::core {

/// Which way and how far (metres) to go from one place to another; of length 0, heading 0.
struct Displacement {
  double heading = 0.0;
  double length = 0.0;

  /// For any two positions.
  static Displacement between(const Position& from, const Position& to);
};

/// Where robots may stop: a vertex is the centre of a cell, numbered row by row from the bottom. Kept apart
/// from what is blocked (LineOfSight).
class Lattice {
 public:
  /// One lattice move.
  struct Step {
    int columns;
    int rows;
  };

  /// `connectivity` is 4, 8, 16 or 32: the moves of the 2^k neighbourhood (Rivera, Hernandez, Baier, AAAI
  /// 2017).
  Lattice(const OccupancyGrid& grid, int connectivity);

  int columns() const { return columns_; }
  int rows() const { return rows_; }
  double spacing() const { return spacing_; }
  int vertex_count() const { return columns_ * rows_; }
  std::span<const Step> steps() const { return steps_; }

  Position position(int vertex) const {
    const int column = vertex % columns_;
    const int row = vertex / columns_;
    return {(column + 0.5) * spacing_, (row + 0.5) * spacing_};
  }
  int vertex(Cell cell) const { return cell.row * columns_ + cell.column; }
  /// From one vertex to another.
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
  /// The vertex that a position coincides with (to kContactTolerance), or -1.
  int vertex_at(const Position& position) const;
  /// Vertices within `distance` metres of a position, ascending.
  std::vector<int> vertices_near(const Position& position, double distance) const;

 private:
  Displacement displacement(int columns, int rows) const;

  int columns_;
  int rows_;
  double spacing_;
  std::vector<Step> steps_;
  // Heading and length of displacements by fewer columns and rows than these; by row, then column.
  int table_columns_;
  int table_rows_;
  std::vector<Displacement> first_quadrant_;
};

/// Which lattice moves a disk of one radius may make on the static map; computed when first asked for. Not
/// thread-safe.
class StaticMoves {
 public:
  StaticMoves(const Lattice& lattice, const LineOfSight& sight, double radius);

  /// Bit k is set if step k of the lattice is free of obstacles from `vertex`.
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
