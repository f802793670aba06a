#pragma once

#include <optional>
#include <vector>

#include "api/request/parse_robots.h"
#include "core/map/occupancy_grid.h"
#include "core/model/problem.h"

namespace fleetplan::api {

/// The problem of a map and the robots whose radius and start could be read; the faults of other robots hide
/// none of these. Poses in obstacles and overlapping starts or goals are faults; then there is no problem,
/// nor if the stop is met.
std::optional<core::Problem> make_problem(core::OccupancyGrid grid, const std::vector<ReadRobot>& robots,
                                          const JsonReader& root, ParseStop& stop);

}  // namespace fleetplan::api
