#include "core/collect_plan.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "core/actions.h"
#include "core/model/served_goals.h"
#include "core/replan/previous_plan.h"

namespace fleetplan::core {
namespace {

Objectives including(const Objectives& objectives, double cost) {
  return {objectives.flowtime + cost, std::max(objectives.makespan, cost)};
}

/// The search may let a robot rest for long enough in a goal's pose and serve the goal when it comes back.
/// The goal counts as served by the first rest, so the later wait is for none.
void remove_wrong_goals(std::vector<Action>& actions, const std::vector<Visit>& visits, std::size_t first) {
  for (std::size_t i = first; i < actions.size(); ++i) {
    std::optional<std::size_t>& goal = actions[i].goal;
    if (goal && *goal < visits.size() && visits[*goal].t_leave <= actions[i].t_start) goal.reset();
  }
}

RobotPlan robot_plan(const PlanState& state, std::size_t index, double bound) {
  const auto& trajectory = state.trajectory(index);
  const Robot& robot = state.instance().robot(index);
  if (!trajectory)
    return {index, robot.committed_until(), robot.committed, robot.committed_until()};  // parked
  const double cost = trajectory->stops_at.value_or(trajectory->cost);
  if (trajectory->is_previous) {
    const std::vector<Action>& actions = previous_actions(robot);
    return {index, cost, actions, std::min(bound, cost), visits_of(robot, actions)};
  }
  // Rounding may leave a bound slightly above the cost that it bounds.
  std::vector<Action> actions = to_actions(robot, *trajectory, state.instance().drive_zones(index));
  std::vector<Visit> visits = visits_of(robot, actions);
  remove_wrong_goals(actions, visits, robot.committed.size());
  RobotPlan plan{index, cost, std::move(actions), std::min(bound, cost), std::move(visits)};
  if (trajectory->stops_at) plan.estimated_cost = trajectory->cost;
  return plan;
}

}  // namespace

std::vector<double> costs_of(const PlanState& state) {
  std::vector<double> costs(state.instance().size(), kForever);
  for (std::size_t i = 0; i < costs.size(); ++i) {
    if (const auto& trajectory = state.trajectory(i)) costs[i] = trajectory->cost;
  }
  return costs;
}

Objectives objectives_of(const PlanState& state) {
  Objectives objectives;
  for (std::size_t i = 0; i < state.instance().size(); ++i) {
    if (const auto& trajectory = state.trajectory(i)) objectives = including(objectives, trajectory->cost);
  }
  return objectives;
}

Plan collect_plan(const PlanState& state, const std::vector<std::optional<Unplanned>>& unplanned,
                  const TautPathBounds& bounds) {
  Plan plan;
  const std::optional<double>& horizon = state.instance().options().horizon;
  if (horizon) plan.estimated = Objectives();
  for (std::size_t i = 0; i < state.instance().size(); ++i) {
    if (unplanned[i]) {
      plan.unplanned.push_back(*unplanned[i]);
      continue;
    }
    // With a horizon, a plan may stop there, or where the committed actions end if that is later.
    double bound = bounds[i];
    if (horizon) bound = std::min(bound, std::max(*horizon, state.instance().itinerary(i).t_begin));
    const RobotPlan& robot = plan.plans.emplace_back(robot_plan(state, i, bound));
    if (horizon) plan.estimated = including(*plan.estimated, robot.estimated_cost.value_or(robot.cost));
    plan.objectives = including(plan.objectives, robot.cost);
    plan.lower_bound = including(plan.lower_bound, robot.lower_bound);
  }
  return plan;
}

}  // namespace fleetplan::core
