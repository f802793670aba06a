#include "core/map/occupancy_grid.h"

#include <cmath>

namespace fleetplan::core {

OccupancyGrid::OccupancyGrid(int columns, int rows, double resolution)
    : columns_(columns),
      rows_(rows),
      resolution_(resolution),
      blocked_(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows), 0) {}

Cell OccupancyGrid::cell_at(const Position& position) const {
  return {static_cast<int>(std::floor(position.x() / resolution_)),
          static_cast<int>(std::floor(position.y() / resolution_))};
}

}  // namespace fleetplan::core
