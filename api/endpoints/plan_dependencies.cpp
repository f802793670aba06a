#include "api/endpoints/plan_dependencies.h"

#include <new>

#include "core/execution/make_dependencies.h"

namespace fleetplan::api {

namespace {

std::optional<core::Dependencies> made_in_memory(const std::vector<core::Robot>& robots,
                                                 const std::vector<core::RobotPlan>& plans,
                                                 const core::DependencyRules& rules,
                                                 const core::StopCondition& stop) {
  try {
    return core::make_dependencies(robots, plans, rules, stop);
  } catch (const std::bad_alloc&) {
    return std::nullopt;
  }
}

}  // namespace

PlanDependencies plan_dependencies(const std::vector<core::Robot>& robots,
                                   const std::vector<core::RobotPlan>& plans,
                                   const RequestedDependencies& requested, double tolerance,
                                   bool has_obstacles, const core::StopCondition& stop) {
  const core::DependencyRules rules{requested.margins, requested.slack, tolerance};
  PlanDependencies dependencies;
  dependencies.made = made_in_memory(robots, plans, rules, stop);
  if (!dependencies.made) {
    dependencies.warnings.emplace_back(
        "The dependencies could not be made with the time and memory of this request, or are too many: "
        "increase time_budget_ms or dependency_slack.");
  } else if (has_obstacles) {
    dependencies.warnings.emplace_back(
        "The dependencies are between robots only: moving obstacles follow the clock.");
  }
  return dependencies;
}

}  // namespace fleetplan::api
