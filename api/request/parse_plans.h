#pragma once

#include <vector>

#include "api/json/json_reader.h"
#include "api/request/parse_robots.h"
#include "api/request/world_frame.h"
#include "core/model/plan.h"

namespace fleetplan::api {

/// Reads the member `plans` of a request to validate: at most one for each robot, in any order. The checker
/// decides later whether the plans are valid.
std::vector<core::RobotPlan> parse_plans(const JsonReader& member, const std::vector<ReadRobot>& robots,
                                         const WorldFrame& frame);

}  // namespace fleetplan::api
