#pragma once

// The cells of the map, and their distances from blocked ones.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/geometry/position.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// A cell of the grid. Column 0 is leftmost, row 0 at the bottom.
struct Cell {
  int column = 0;
  int row = 0;
  bool operator==(const Cell&) const = default;
};

/// The blocked cells of the map. A blocked cell is a closed square. Everything outside the map is blocked as
/// well. Map frame: cell (c, r) covers [c, c+1] x [r, r+1] times the resolution.
class OccupancyGrid {
 public:
  /// A free map of `columns` x `rows` cells (both >= 1) of `resolution` metres (> 0) each.
  OccupancyGrid(int columns, int rows, double resolution);

  int columns() const { return columns_; }
  int rows() const { return rows_; }
  double resolution() const { return resolution_; }
  double width() const { return columns_ * resolution_; }
  double height() const { return rows_ * resolution_; }
  std::int64_t cell_count() const { return static_cast<std::int64_t>(columns_) * rows_; }

  bool inside(Cell cell) const {
    return cell.column >= 0 && cell.column < columns_ && cell.row >= 0 && cell.row < rows_;
  }
  /// Whether the cell is blocked; true for cells outside the map, too.
  bool blocked(Cell cell) const { return !inside(cell) || blocked_[index(cell)] != 0; }
  void block(Cell cell) { blocked_[index(cell)] = 1; }
  /// The cells of a row, 1 for blocked ones.
  std::span<const std::uint8_t> row(int row) const {
    return std::span(blocked_).subspan(index({0, row}), static_cast<std::size_t>(columns_));
  }

  Position center(Cell cell) const {
    return {(cell.column + 0.5) * resolution_, (cell.row + 0.5) * resolution_};
  }
  /// Returns the cell of a position; on a border, the cell to the right or above. It may be outside the map.
  Cell cell_at(const Position& position) const;

  bool operator==(const OccupancyGrid&) const = default;
  /// Returns the hash of the sizes, the resolution and all cells.
  std::size_t hash() const;

  std::size_t index(Cell cell) const {
    return static_cast<std::size_t>(cell.row) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(cell.column);
  }

 private:
  int columns_;
  int rows_;
  double resolution_;
  std::vector<std::uint8_t> blocked_;  // row by row from the bottom, 1 = blocked
};

/// Returns the distance in metres from a position to the nearest blocked cell or edge of the map, at most
/// `limit` (> 0, metres). Outside the map, returns minus the distance to the map.
double obstacle_distance(const OccupancyGrid& grid, const Position& position, double limit);

/// The distance from each cell to the nearest blocked cell, by the linear-time exact algorithm of Meijster,
/// Roerdink and Hesselink (2000). Everything outside the map is blocked.
class DistanceTransform {
 public:
  /// Longer distances are cut off: 255 cells.
  static constexpr std::uint16_t kMaxSquared = 255 * 255;

  /// Computes the distances. If `stop` is met first, the object is not finished() and must not be used.
  DistanceTransform(const OccupancyGrid& grid, const StopCondition& stop);

  bool finished() const { return finished_; }

  /// The squared distance, in cells, between the centre of a cell and the centre of the nearest blocked cell.
  /// At most kMaxSquared; 0 for a blocked cell. `cell` is inside the map.
  std::uint16_t squared(Cell cell) const {
    const auto column = static_cast<std::size_t>(cell.column);
    const auto row = static_cast<std::size_t>(cell.row);
    return squared_[row / kTileRows * kTileRows * stride_ + tiled(column, row % kTileRows)];
  }

  std::size_t bytes() const { return squared_.capacity() * sizeof(std::uint16_t); }

 private:
  /// A tile is as large as a line of a CPU's cache, so that neighbours of a cell are likely to share its
  /// line.
  static constexpr std::size_t kTileColumns = 8;
  static constexpr std::size_t kTileRows = 4;
  static std::size_t tiled(std::size_t column, std::size_t row_in_tile) {
    return column / kTileColumns * kTileColumns * kTileRows + row_in_tile * kTileColumns +
           column % kTileColumns;
  }

  bool scan_columns(const OccupancyGrid& grid, StopStride& stop);
  bool scan_rows(StopStride& stop);
  bool make_tiles(StopStride& stop);

  int columns_;
  int rows_;
  std::size_t stride_;                  // columns, rounded up to tiles
  std::vector<std::uint16_t> squared_;  // by rows of tiles, tile, and row in it
  bool finished_ = false;
};

}  // namespace fleetplan::core
