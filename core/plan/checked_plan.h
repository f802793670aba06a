#pragma once

// What is returned of a plan: only what has passed the check.

#include <functional>
#include <optional>

#include "core/model/plan.h"
#include "core/model/plan_options.h"
#include "core/model/problem.h"
#include "core/runtime/budget.h"
#include "core/runtime/stop_condition.h"
#include "core/verify/verify.h"

namespace fleetplan::core {

/// What the check says of a plan, or of the one that is used instead; no report if it was not finished, so
/// that neither must be used.
struct CheckOfPlan {
  std::optional<VerifyReport> report;
  std::optional<Plan> instead;

  const Plan& checked(const Plan& plan) const { return instead ? *instead : plan; }
};

/// Checks a plan of the planner until `stop` is met. If that does not suffice, another one is used instead,
/// in which all robots that would move stay at their starts, or at the end of what is committed; `last`,
/// which is asked then, ends its check.
CheckOfPlan check(const Plan& plan, const Problem& problem, const PlanOptions& options,
                  const StopCondition& stop, const std::function<auto()->StopCondition>& last);

/// Checks a plan that was made until `planning`. The check has at least the CPU time that a thousand robots
/// with few moves need.
CheckOfPlan check(const Plan& plan, const Problem& problem, const PlanOptions& options,
                  const StopCondition& planning, const budget::CheckPatience& patience);

}  // namespace fleetplan::core
