#pragma once

#include <optional>

#include "core/model/plan.h"
#include "core/model/plan_options.h"
#include "core/model/problem.h"
#include "core/runtime/stop_condition.h"
#include "core/verify/verify.h"

namespace fleetplan::library {

/// The check of a plan of the planner; none if `stop` is met first.
std::optional<core::VerifyReport> check_plan(const core::Problem& problem, const core::PlanOptions& options,
                                             const core::Plan& plan, const core::StopCondition& stop);

}  // namespace fleetplan::library
