#pragma once

// The request of POST /v1/retime and its answer.

#include <optional>
#include <string>
#include <vector>

#include "api/json/json_reader.h"
#include "api/request/limits.h"
#include "core/execution/dependencies.h"
#include "core/execution/retime.h"
#include "core/model/plan.h"
#include "core/model/robot.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::api {

/// A readable body of POST /v1/retime, in the client's world.
struct RetimeRequest {
  std::vector<core::Robot> robots;
  std::vector<core::RobotPlan> plans;
  std::vector<core::Dependency> dependencies;
  std::vector<core::ObservedState> states;  // at most one for each robot
  core::RetimeRules rules;
};

/// Reads the root of the document. Returns none if it has faults, or if `work` is met.
std::optional<RetimeRequest> parse_retime_request(const JsonReader& root, const Limits& limits,
                                                  core::Work& work);

/// Returns the answer of POST /v1/retime. `retimed` is by robot. Returns none if `work` is met.
std::optional<std::string> write_retimed(const RetimeRequest& request,
                                         const std::vector<core::RetimedRobot>& retimed, core::Work& work);

}  // namespace fleetplan::api
