#include "core/verify/check_plan.h"

#include "core/verify/tolerances.h"

namespace fleetplan::core {

std::optional<VerifyReport> check_plan(const Problem& problem, const PlanOptions& options, const Plan& plan,
                                       const StopCondition& stop) {
  CheckRules rules{plan_tolerances(problem.grid(), problem.robots(), plan.plans)};
  rules.interval_margin = options.interval_margin;
  rules.start_overlap = options.start_overlap;
  rules.horizon = options.horizon;
  rules.exact_commitments = true;
  rules.exempt = plan.unavoidable;
  return verify({problem.grid(), problem.robots(), problem.obstacles(), &problem.zones()}, plan.plans, rules,
                stop);
}

}  // namespace fleetplan::core
