#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace fleetplan::api {

inline constexpr std::int8_t kUnknownOccupancy = -1;

/// Occupancy of cells as in nav_msgs/OccupancyGrid: 0 to 100 percent, or -1 where it is unknown.
struct Raster {
  int columns = 0;
  int rows = 0;
  std::vector<std::int8_t> occupancy;  // row by row from the bottom, each from the left

  std::int8_t at(int column, int row) const {
    return occupancy[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
                     static_cast<std::size_t>(column)];
  }
};

}  // namespace fleetplan::api
