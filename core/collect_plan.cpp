#include "core/collect_plan.h"

#include <algorithm>

#include "core/actions.h"
#include "core/replan/previous_plan.h"

namespace fleetplan::core {
namespace {

Objectives including(const Objectives& objectives, double cost) {
  return {objectives.flowtime + cost, std::max(objectives.makespan, cost)};
}

RobotPlan robot_plan(const PlanState& state, std::size_t index, double bound) {
  const auto& trajectory = state.trajectory(index);
  if (!trajectory) return {index, 0.0, {}, 0.0};  // parked
  const double cost = trajectory->cost;
  const Robot& robot = state.instance().robot(index);
  if (trajectory->is_previous) {
    return {index, cost, previous_actions(robot), std::min(bound, cost), previous_visits(robot)};
  }
  // Rounding may leave a bound slightly above the cost that it bounds.
  return {index, cost, to_actions(robot, *trajectory), std::min(bound, cost)};
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
  for (std::size_t i = 0; i < state.instance().size(); ++i) {
    if (unplanned[i]) {
      plan.unplanned.push_back(*unplanned[i]);
      continue;
    }
    const RobotPlan& robot = plan.plans.emplace_back(robot_plan(state, i, bounds[i]));
    plan.objectives = including(plan.objectives, robot.cost);
    plan.lower_bound = including(plan.lower_bound, robot.lower_bound);
  }
  return plan;
}

}  // namespace fleetplan::core
