#include "api/response/plan_outcome.h"

#include "core/model/plan.h"

namespace fleetplan::api {

std::string_view name_of(PlanOutcome::Status status) {
  switch (status) {
    case PlanOutcome::Status::solved:
      return "solved";
    case PlanOutcome::Status::partial:
      return "partial";
    case PlanOutcome::Status::none:
      return "none";
    case PlanOutcome::Status::refused:
      break;
  }
  return "refused";
}

PlanOutcome::Status status_of(const core::Plan& plan) {
  if (plan.unplanned.empty()) return PlanOutcome::Status::solved;
  return plan.plans.empty() ? PlanOutcome::Status::none : PlanOutcome::Status::partial;
}

PlanOutcome outcome_of(const core::Plan& plan, std::optional<double> plan_seconds) {
  return {status_of(plan),        plan.plans.size(),        plan.unplanned.size(),
          plan.search.expansions, plan.objectives.flowtime, plan_seconds};
}

}  // namespace fleetplan::api
