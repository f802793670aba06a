#pragma once

// What is returned of a plan: only what has passed the check.

#include <functional>
#include <optional>

#include "core/model/plan.h"
#include "core/model/plan_options.h"
#include "core/model/problem.h"
#include "core/runtime/stop_condition.h"
#include "core/verify/verify.h"

namespace fleetplan::core {

/// A plan and its check; none if that was not finished, so that the plan must not be used.
struct CheckedPlan {
  Plan plan;
  std::optional<VerifyReport> report;
};

/// Checks a plan of the planner until `stop` is met. If that does not suffice, the plan is one in which all
/// robots that would move stay at their starts, or at the end of what is committed; `last`, which is asked
/// then, ends its check.
CheckedPlan check(const Plan& plan, const Problem& problem, const PlanOptions& options,
                  const StopCondition& stop, const std::function<auto()->StopCondition>& last);

}  // namespace fleetplan::core
