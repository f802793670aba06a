#pragma once

// What robots execute, as far as it is planned, and when progress in it is planned.

#include <cstddef>
#include <span>
#include <vector>

#include "core/execution/dependency.h"
#include "core/model/action.h"
#include "core/model/plan.h"
#include "core/model/robot.h"

namespace fleetplan::core {

/// The actions of one robot.
using Actions = std::span<const Action>;

/// By robot: those of its plan, or the committed ones without a plan (none if it is invalid). They refer to
/// the arguments.
std::vector<Actions> executed_actions(const std::vector<Robot>& robots, const std::vector<RobotPlan>& plans);

/// The planned time of a progress in these actions, seconds. An action without duration happens when it ends.
double planned_time(Actions actions, std::size_t action, double fraction);

}  // namespace fleetplan::core
