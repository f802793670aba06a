#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/map/occupancy_grid.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// The distance from each cell to the nearest blocked one, by the linear-time exact algorithm of Meijster,
/// Roerdink and Hesselink (2000). What is outside the map is blocked.
class DistanceTransform {
 public:
  /// Longer distances are cut off: 255 cells.
  static constexpr std::uint16_t kMostSquared = 255 * 255;

  /// Computes the distances. If `stop` is met first, the object is not finished() and must not be used.
  DistanceTransform(const OccupancyGrid& grid, const StopCondition& stop);

  bool finished() const { return finished_; }

  /// The squared distance of the centre of a cell from the centre of the nearest blocked cell, in cells, at
  /// most kMostSquared; 0 for a blocked cell. `cell` is inside the map.
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
