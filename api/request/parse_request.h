#pragma once

// The bodies of requests to plan and to validate.

#include <chrono>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "api/json/errors.h"
#include "api/json/json_reader.h"
#include "api/request/limits.h"
#include "api/request/map/parse_map.h"
#include "api/request/options.h"
#include "api/request/shared_members.h"
#include "core/map/occupancy_grid.h"
#include "core/map/static_map.h"
#include "core/model/plan.h"
#include "core/model/plan_options.h"
#include "core/model/problem.h"
#include "core/model/robot.h"
#include "core/model/surroundings.h"
#include "core/runtime/stop_condition.h"
#include "core/travel/goal_choice.h"
#include "core/verify/check_rules.h"

namespace fleetplan::api {

/// A valid body of POST /v1/plan.
struct PlanRequest {
  core::Problem problem;  // problem in the map frame
  core::PlanOptions options;
  std::chrono::nanoseconds budget;  // the smaller one of the request's budget and the service's
  WorldFrame frame;
  std::vector<std::string> warnings;
  std::vector<ReceivedRobot> received;  // by robot
  std::string metadata;                 // see parse_metadata
  RequestedDependencies dependencies;
  std::optional<core::OpenFleet> open = {};  // if goals are open; the problem is made of these robots
  std::vector<double> body_radii;            // by robot: metres, of the robot itself, when it is executed
};

/// Tells the answer which poses are chosen for the open goals.
void tell_choices(const core::OpenGoals& open, std::vector<ReceivedRobot>& received);

/// Reads a request of POST /v1/plan, which may be a part of a body. Returns none only if it reported faults,
/// or if `work` is met.
std::optional<PlanRequest> parse_plan_request(const JsonReader& request, const Limits& limits,
                                              core::Work& work, core::MapCache* maps);

/// Reads a body of POST /v1/plan. Ends with `parse_unfinished` or `draining` when `work` is met. `maps`,
/// which may be null, has the maps of earlier requests.
Result<PlanRequest, RequestError> parse_request(std::string_view body, const Limits& limits, core::Work& work,
                                                core::MapCache* maps = nullptr);

/// A readable body of POST /v1/validate. Robots may overlap obstacles and each other; the checker reports
/// this.
struct ValidateRequest {
  core::OccupancyGrid grid;
  std::vector<core::Robot> robots;
  std::vector<core::MovingObstacle> obstacles;
  std::vector<core::Zone> zones;
  std::vector<core::RobotPlan> plans;
  RequestedDependencies dependencies;
  core::CheckRules rules;             // the tolerance is in metres, seconds and radians
  std::chrono::nanoseconds budget{};  // time for the check
};

/// Reads a body of POST /v1/validate. Ends with `parse_unfinished` or `draining` when `work` is met.
Result<ValidateRequest, RequestError> parse_validate_request(std::string_view body, const Limits& limits,
                                                             core::Work& work);

}  // namespace fleetplan::api
