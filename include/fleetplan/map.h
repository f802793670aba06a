#pragma once

#include <fleetplan/pose.h>

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <span>
#include <string_view>
#include <vector>

namespace fleetplan {

/// The blocked and free cells of the plane. Cells are closed squares. Column 0 is leftmost, row 0 is at the
/// bottom. Cell (c, r) covers [c, c+1] x [r, r+1] times the resolution, from the origin on. Everything
/// outside the map is blocked.
class Map {
 public:
  /// A free map of `columns` x `rows` cells (both at least 1) of `resolution` metres. `origin` is the lower
  /// left corner in the coordinates of robots, goals, obstacles and zones. Throws std::invalid_argument if
  /// a number is out of range (limits.h), or if the map has more than 1e9 cells.
  Map(int columns, int rows, double resolution, Position origin = {});

  /// Makes a map from text, the top row first. `.` and `G` are free; `#`, `@`, `O`, `T` and `W` are blocked.
  /// All rows must have the same length. Throws std::invalid_argument otherwise, and as the constructor does.
  static Map from_rows(std::span<const std::string_view> rows, double resolution, Position origin = {});
  static Map from_rows(std::initializer_list<std::string_view> rows, double resolution,
                       Position origin = {}) {
    return from_rows(std::span(rows.begin(), rows.size()), resolution, origin);
  }

  /// Takes cells row by row from the bottom, as in an occupancy grid of ROS. A cell is free if it is 0.
  /// Throws std::invalid_argument if their number is not `columns` x `rows`, and as the constructor does.
  static Map from_cells(std::span<const std::uint8_t> cells, int columns, int rows, double resolution,
                        Position origin = {});

  int columns() const { return columns_; }
  int rows() const { return rows_; }
  double resolution() const { return resolution_; }  // metres
  Position origin() const { return origin_; }

  /// Whether a cell is blocked; true for cells outside the map, too.
  bool blocked(int column, int row) const {
    return column < 0 || column >= columns_ || row < 0 || row >= rows_ || cells_[index(column, row)] != 0;
  }
  /// Blocks or frees a cell. Throws std::out_of_range if it is outside the map.
  void block(int column, int row, bool blocked = true);
  /// Returns the centre of a cell, which may be outside the map.
  Position center(int column, int row) const {
    return {origin_.x + (column + 0.5) * resolution_, origin_.y + (row + 0.5) * resolution_};
  }
  /// The cells row by row from the bottom, 1 for blocked ones.
  std::span<const std::uint8_t> cells() const { return cells_; }

 private:
  std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(column);
  }

  int columns_;
  int rows_;
  double resolution_;
  Position origin_;
  std::vector<std::uint8_t> cells_;
};

}  // namespace fleetplan
