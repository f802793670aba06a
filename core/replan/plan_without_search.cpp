#include "core/replan/plan_without_search.h"

#include <algorithm>
#include <new>
#include <utility>
#include <vector>

#include "core/bounds/lower_bound.h"
#include "core/meetings.h"
#include "core/model/motion_of.h"
#include "core/model/served_goals.h"
#include "core/model/unplanned_invalid.h"
#include "core/replan/kept_plans.h"
#include "core/replan/previous_plan.h"

namespace fleetplan::core {
namespace {

/// None where the memory does not suffice for the check.
KeptPlans plans_that_are_safe(const Problem& problem, const PlanOptions& options, const StopCondition& stop) {
  try {
    return keep_previous_plans(problem, options, stop, LeftOut::stay);
  } catch (const std::bad_alloc&) {
    return {};
  }
}

}  // namespace

Plan plan_without_search(const Problem& problem, const PlanOptions& options, const char* detail,
                         const StopCondition& stop) {
  const KeptPlans previous = plans_that_are_safe(problem, options, stop);
  Plan plan;
  std::vector<bool> planned(problem.robots().size(), false);
  for (std::size_t index = 0; index < problem.robots().size(); ++index) {
    const Robot& robot = problem.robots()[index];
    if (robot.invalid) {
      plan.unplanned.push_back(unplanned_invalid(index));
      continue;
    }
    if (robot.goal && !previous.contains(index)) {
      plan.unplanned.push_back({index, Unplanned::Reason::budget_exhausted, detail, {}});
      continue;
    }
    RobotPlan kept = previous_plan(index, robot);
    kept.visits = visits_of(robot, kept.actions);
    kept.lower_bound =
        robot.goal ? std::min(kept.cost, lower_bound(robot, motion_of(robot, options))) : kept.cost;
    planned[index] = robot.goal.has_value();
    plan.objectives.flowtime += kept.cost;
    plan.objectives.makespan = std::max(plan.objectives.makespan, kept.cost);
    plan.lower_bound.flowtime += kept.lower_bound;
    plan.lower_bound.makespan = std::max(plan.lower_bound.makespan, kept.lower_bound);
    plan.plans.push_back(std::move(kept));
  }
  UnavoidableMeetings found = unavoidable_meetings(problem, planned, stop);
  plan.unavoidable = std::move(found.meetings);
  plan.meetings_known = found.finished;
  plan.deterministic = false;
  return plan;
}

}  // namespace fleetplan::core
