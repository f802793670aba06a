#pragma once

#include <optional>
#include <vector>

#include "api/json/fault_list.h"
#include "api/request/parse_robots.h"
#include "core/map/occupancy_grid.h"
#include "core/model/problem.h"

namespace fleetplan::api {

/// The problem that a map and robots make, or nothing when they make none or there were faults before. Poses
/// in obstacles and overlapping starts or goals are added to the faults, also when other robots could not be
/// read: their faults hide none of the rest.
std::optional<core::Problem> make_problem(core::OccupancyGrid grid, std::vector<ReadRobot> robots,
                                          FaultList& faults);

}  // namespace fleetplan::api
