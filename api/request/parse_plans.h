#pragma once

#include <vector>

#include "api/json/fault_list.h"
#include "api/json/json_path.h"
#include "api/json/json_value.h"
#include "api/request/parse_robots.h"
#include "api/request/world_frame.h"
#include "core/model/plan.h"

namespace fleetplan::api {

/// Reads the member `plans` of a request to validate: at most one a robot, in any order. Whether the plans
/// are any good is not judged here.
std::vector<core::RobotPlan> parse_plans(const JsonValue& value, const JsonPath& path,
                                         const std::vector<ReadRobot>& robots, const WorldFrame& frame,
                                         FaultList& faults);

}  // namespace fleetplan::api
