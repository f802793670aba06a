#include "core/replan/follow_kept.h"

#include <algorithm>
#include <new>
#include <utility>
#include <vector>

#include "core/bounds/lower_bound.h"
#include "core/commitments/unavoidable_collisions.h"
#include "core/instance/motion.h"
#include "core/model/itinerary.h"

namespace fleetplan::core {

std::size_t follow_kept_plans(PlanState& state, const KeptPlans& previous, const KeptPlans& certain) {
  std::size_t followed = 0;
  for (std::size_t robot = 0; robot < previous.kept.size(); ++robot) {
    if (!previous.kept[robot]) continue;
    Trajectory trajectory = previous_trajectory(state.instance().robot(robot));
    // The checker has accepted all kept plans together, and against what all robots are committed to.
    const auto is_kept = [&](std::size_t other) { return bool(previous.kept[other]); };
    const std::vector<std::size_t> others = state.conflicting_robots(robot, trajectory);
    if (!certain.contains(robot) && !std::all_of(others.begin(), others.end(), is_kept)) continue;
    state.follow(robot, std::move(trajectory));
    ++followed;
  }
  return followed;
}

void finish_with_kept_plans(PlanState& state, const std::vector<std::size_t>& movers) {
  PlanState::Reservations reservations = state.reservations();
  for (const std::size_t robot : movers) {
    reservations.trajectories[robot] = previous_trajectory(state.instance().robot(robot));
  }
  state.finish_with(reservations);
}

namespace {

/// Returns the previous plans that hold if all other robots stay; none where the memory does not suffice for
/// the check.
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
  UnavoidableCollisions found = unavoidable_collisions(problem, planned, stop);
  plan.unavoidable = std::move(found.collisions);
  plan.unavoidable_known = found.finished;
  plan.deterministic = false;
  return plan;
}

}  // namespace fleetplan::core
