#pragma once

// Only a plan that has passed the check is returned.

#include <functional>
#include <optional>

#include "core/model/plan.h"
#include "core/model/plan_options.h"
#include "core/model/problem.h"
#include "core/runtime/budget.h"
#include "core/runtime/stop_condition.h"
#include "core/verify/verify.h"

namespace fleetplan::core {

/// What the check says of a plan, or of the plan that replaces it. There is no report if the check was not
/// finished; then neither plan may be used.
struct CheckOfPlan {
  std::optional<VerifyReport> report;
  std::optional<Plan> instead;

  const Plan& checked(const Plan& plan) const { return instead ? *instead : plan; }
};

/// Checks a plan of the planner until `stop` is met. If the time does not suffice, another plan replaces it.
/// In this plan, all robots that would move stay at their starts, or at the end of their commitments. The
/// check of that plan ends with the stop condition that `last` returns; it is called only then.
CheckOfPlan check(const Plan& plan, const Problem& problem, const PlanOptions& options,
                  const StopCondition& stop, const std::function<auto()->StopCondition>& last);

/// Checks a plan that was made until `planning`. The check has at least the CPU time that a thousand robots
/// with few moves need.
CheckOfPlan check(const Plan& plan, const Problem& problem, const PlanOptions& options,
                  const StopCondition& planning, const budget::CheckPatience& patience);

}  // namespace fleetplan::core
