#pragma once

#include <cstdint>
#include <vector>

#include "core/map/occupancy_grid.h"

namespace fleetplan::core {

/// The distance from each cell to the nearest blocked one, by the linear-time exact algorithm of Meijster,
/// Roerdink and Hesselink (2000). What is outside the map is blocked.
class DistanceTransform {
 public:
  /// Longer distances are cut off: 255 cells.
  static constexpr std::uint16_t kMostSquared = 255 * 255;

  explicit DistanceTransform(const OccupancyGrid& grid);

  /// Of the centres, in cells, at most kMostSquared; 0 for a blocked cell. `cell` is inside the map.
  std::uint16_t squared(Cell cell) const {
    return squared_[static_cast<std::size_t>(cell.row) * static_cast<std::size_t>(columns_) +
                    static_cast<std::size_t>(cell.column)];
  }

 private:
  void scan_columns(const OccupancyGrid& grid);
  void scan_rows();

  int columns_;
  int rows_;
  std::vector<std::uint16_t> squared_;
};

}  // namespace fleetplan::core
