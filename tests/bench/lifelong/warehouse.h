#pragma once

#include <vector>

#include "core/geometry/position.h"
#include "core/map/occupancy_grid.h"

namespace fleetplan::bench {

/// The warehouse of the example requests, with another number of shelves. It has blocks of 16 x 2 cells of
/// 0.5 m with aisles of 3 cells between them, and pick stations along the west wall.
struct Warehouse {
  int shelf_columns = 3;
  int shelf_rows = 8;
};

core::OccupancyGrid warehouse_map(const Warehouse& warehouse);

/// The poses in front of every cell of every shelf, from below and from above, for a robot of `radius`
/// metres. The robot faces the shelf, 5 cm from it.
std::vector<core::Pose> shelf_places(const Warehouse& warehouse, double radius);

}  // namespace fleetplan::bench
