#include "core/plan/checked_plan.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "core/explain/unavoidable_collisions.h"
#include "core/model/itinerary.h"

namespace fleetplan::core {

namespace {

bool moves(const RobotPlan& plan, const Problem& problem) {
  return plan.actions.size() > problem.robots()[plan.robot].committed.size();
}

/// Returns the rest of a plan when all robots that would move stay at their starts, or at the end of their
/// commitments.
Plan without_moves(const Plan& plan, const Problem& problem, const StopCondition& stop) {
  Plan left;
  left.deterministic = false;
  left.search = plan.search;
  left.unplanned = plan.unplanned;
  if (plan.estimated) left.estimated = Objectives();
  for (const RobotPlan& robot : plan.plans) {
    const Robot& of = problem.robots()[robot.robot];
    if (moves(robot, problem) && of.is_idle()) {
      left.plans.push_back({robot.robot, of.committed_until(), of.committed, of.committed_until()});
      if (left.estimated) left.estimated->flowtime += of.committed_until();
    } else if (!moves(robot, problem)) {
      left.plans.push_back(robot);
      if (left.estimated) left.estimated->flowtime += robot.cost;
    } else {
      left.unplanned.push_back({robot.robot,
                                Unplanned::Reason::budget_exhausted,
                                "The time budget ended before the plan was checked.",
                                {}});
    }
  }
  std::sort(left.unplanned.begin(), left.unplanned.end(),
            [](const Unplanned& a, const Unplanned& b) { return a.robot < b.robot; });
  // A robot that is at its goal, or has none, stays, too.
  UnavoidableCollisions found = unavoidable_collisions(
      problem, itineraries_of(problem.robots()), std::vector<bool>(problem.robots().size(), false), stop);
  left.unavoidable = std::move(found.collisions);
  left.unavoidable_known = found.finished;
  return left;
}

/// Returns the condition for the check of the plan that was made. A plan that was cancelled may still be
/// checked quickly.
StopCondition stop_of_check(const StopCondition& planning, const budget::CheckPatience& patience) {
  const auto now = StopCondition::Clock::now();
  if (planning.cancelled()) return planning.even_if_cancelled(now + patience.if_cancelled);
  if (patience.despite_cancel) {
    return planning.even_if_cancelled(std::max(planning.deadline(), now + patience.after_planning));
  }
  if (planning.deadline() == StopCondition::Clock::time_point::max()) return planning;
  return planning.until(planning.deadline() + patience.after_planning)
      .with_cpu_time(budget::kLeastCpuOfCheck);
}

/// Returns the condition for the check of a plan in which nobody moves.
StopCondition last_stop(const StopCondition& planning, const budget::CheckPatience& patience) {
  const auto end = StopCondition::Clock::now() + patience.for_nobody;
  if (planning.cancelled()) return planning.even_if_cancelled(end);
  const auto later = std::max(end, stop_of_check(planning, patience).deadline());
  return patience.despite_cancel ? planning.even_if_cancelled(later) : planning.until(later);
}

}  // namespace

CheckOfPlan check(const Plan& plan, const Problem& problem, const PlanOptions& options,
                  const StopCondition& stop, const std::function<auto()->StopCondition>& last) {
  CheckOfPlan check;
  const bool any_moves = std::any_of(plan.plans.begin(), plan.plans.end(),
                                     [&](const RobotPlan& robot) { return moves(robot, problem); });
  if (any_moves && plan.unavoidable_known) check.report = check_plan(problem, options, plan, stop);
  if (check.report) return check;
  const StopCondition end = last();
  if (any_moves || !plan.unavoidable_known) check.instead = without_moves(plan, problem, end);
  const Plan& left = check.checked(plan);
  if (left.unavoidable_known) check.report = check_plan(problem, options, left, end);
  return check;
}

CheckOfPlan check(const Plan& plan, const Problem& problem, const PlanOptions& options,
                  const StopCondition& planning, const budget::CheckPatience& patience) {
  return check(plan, problem, options, stop_of_check(planning, patience).despite_memory(),
               [&] { return last_stop(planning, patience).despite_memory(); });
}

}  // namespace fleetplan::core
