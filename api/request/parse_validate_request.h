#pragma once

#include <chrono>
#include <string_view>
#include <vector>

#include "api/json/error.h"
#include "api/json/result.h"
#include "api/request/limits.h"
#include "api/request/requested_dependencies.h"
#include "core/map/occupancy_grid.h"
#include "core/model/moving_obstacle.h"
#include "core/model/plan.h"
#include "core/model/robot.h"
#include "core/model/zone.h"
#include "core/runtime/work.h"
#include "core/verify/check_rules.h"

namespace fleetplan::api {

/// A readable body of POST /v1/validate. Robots may overlap obstacles and each other: the checker reports
/// that.
struct ValidateRequest {
  core::OccupancyGrid grid;
  std::vector<core::Robot> robots;
  std::vector<core::MovingObstacle> obstacles;
  std::vector<core::Zone> zones;
  std::vector<core::RobotPlan> plans;
  RequestedDependencies dependencies;
  core::CheckRules rules;             // the tolerance is in metres, seconds and radians
  std::chrono::nanoseconds budget{};  // of the check
};

/// Reads a body of POST /v1/validate; ends with `parse_unfinished` or `draining` when the stop is met.
Result<ValidateRequest, RequestError> parse_validate_request(std::string_view body, const Limits& limits,
                                                             core::Work& stop);

}  // namespace fleetplan::api
