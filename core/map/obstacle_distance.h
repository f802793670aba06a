#pragma once

#include "core/map/occupancy_grid.h"

namespace fleetplan::core {

/// The distance in metres from a position to the nearest blocked point, a blocked cell's or the map's edge,
/// if it is below `limit` (> 0, metres); `limit` otherwise. Outside the map it is minus the distance to the
/// map.
double obstacle_distance(const OccupancyGrid& grid, const Position& position, double limit);

}  // namespace fleetplan::core
