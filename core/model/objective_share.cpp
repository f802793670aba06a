#include "core/model/objective_share.h"

#include <algorithm>

namespace fleetplan::core {
namespace {

using Objective = PlanOptions::Objective;

/// With the objective `tardiness`, a second of cost counts as so many seconds of delay: too few to matter
/// but where delays are equal, and enough for gains of cost to be told from rounding.
constexpr double kShareOfCost = 1e-4;

double total_delay(const Robot& robot, const std::vector<Visit>& visits) {
  double sum = 0.0;
  for (const Visit& visit : visits) {
    sum += late_by(robot.goal_at(visit.goal), visit.t_arrive).value_or(0.0);
  }
  return sum;
}

/// The delay at the last goal of a robot that ends its service there at `cost`. One that waits for
/// `not_before` is not late.
double delay_at_last(const Robot& robot, double cost) {
  return late_by(*robot.goal, cost - robot.goal->service).value_or(0.0);
}

double with_cost(const Robot& robot, double delay, double cost) {
  return robot.weight * (delay + kShareOfCost * cost);
}

}  // namespace

std::optional<double> late_by(const Goal& goal, double t_arrive) {
  return goal.due ? std::optional(std::max(0.0, t_arrive - *goal.due)) : std::nullopt;
}

double share_of(const Robot& robot, Objective objective, const Trajectory& trajectory) {
  if (objective != Objective::tardiness) return robot.weight * trajectory.cost;
  double delay = total_delay(robot, trajectory.visits);
  delay += trajectory.stops_at ? total_delay(robot, trajectory.estimated_visits)
                               : delay_at_last(robot, trajectory.cost);
  return with_cost(robot, delay, trajectory.cost);
}

double least_share(const Robot& robot, Objective objective, double cost) {
  if (objective != Objective::tardiness) return robot.weight * cost;
  return with_cost(robot, delay_at_last(robot, cost), cost);
}

double cost_with_share(const Robot& robot, Objective objective, double share) {
  const double seconds = share / robot.weight;
  if (objective != Objective::tardiness) return seconds;
  const double if_in_time = seconds / kShareOfCost;
  if (!robot.goal->due) return if_in_time;
  const double late_from = *robot.goal->due + robot.goal->service;
  const double if_late = (seconds + late_from) / (1.0 + kShareOfCost);
  return std::min(if_in_time, std::max(if_late, late_from));
}

double objective_value(const Plan& plan, const std::vector<Robot>& robots, Objective objective) {
  double value = 0.0;
  for (const RobotPlan& one : plan.plans) {
    const Robot& robot = robots[one.robot];
    const double cost = one.estimated_cost.value_or(one.cost);
    if (cost == kForever) continue;
    if (objective == Objective::makespan) {
      value = std::max(value, cost);
    } else if (objective == Objective::flowtime) {
      value += robot.weight * cost;
    } else {
      value += robot.weight * (total_delay(robot, one.visits) + total_delay(robot, one.estimated_visits));
    }
  }
  return value;
}

}  // namespace fleetplan::core
