#pragma once

#include "core/map/occupancy_grid.h"

namespace fleetplan::core {

/// The distance in metres from a position to the nearest blocked cell or edge of the map, at most `limit` (>
/// 0, metres). Outside the map it is minus the distance to the map.
double obstacle_distance(const OccupancyGrid& grid, const Position& position, double limit);

}  // namespace fleetplan::core
