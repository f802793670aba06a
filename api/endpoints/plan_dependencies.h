#pragma once

#include <optional>
#include <string>
#include <vector>

#include "api/request/requested_dependencies.h"
#include "core/execution/dependency.h"
#include "core/model/plan.h"
#include "core/model/robot.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::api {

/// The dependencies of a plan that has passed the check, and what to tell about them.
struct PlanDependencies {
  std::optional<core::Dependencies> made;  // nothing: time or memory did not suffice
  std::vector<std::string> warnings;
};

/// `tolerance`: metres, of the check.
PlanDependencies plan_dependencies(const std::vector<core::Robot>& robots,
                                   const std::vector<core::RobotPlan>& plans,
                                   const RequestedDependencies& requested, double tolerance,
                                   bool has_obstacles, const core::StopCondition& stop);

}  // namespace fleetplan::api
