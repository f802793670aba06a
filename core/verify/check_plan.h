#pragma once

#include <optional>

#include "core/model/plan.h"
#include "core/model/plan_options.h"
#include "core/model/problem.h"
#include "core/runtime/stop_condition.h"
#include "core/verify/verify.h"

namespace fleetplan::core {

/// The check of a plan of the planner; none if `stop` is met first.
std::optional<VerifyReport> check_plan(const Problem& problem, const PlanOptions& options, const Plan& plan,
                                       const StopCondition& stop);

}  // namespace fleetplan::core
