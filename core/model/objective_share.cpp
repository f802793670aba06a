#include "core/model/objective_share.h"

#include <algorithm>

namespace fleetplan::core {
namespace {

using Objective = PlanOptions::Objective;

/// With the objective `tardiness`, a second of cost counts as so many seconds of delay. They are so few that
/// they matter only if delays are equal, and enough to tell gains of cost from rounding.
constexpr double kShareOfCost = 1e-4;

/// `goal_of` returns the goal with a number.
template <class GoalOf>
double total_delay(const std::vector<Visit>& visits, const GoalOf& goal_of) {
  double sum = 0.0;
  for (const Visit& visit : visits) sum += late_by(goal_of(visit.goal), visit.t_arrive).value_or(0.0);
  return sum;
}

/// The delay at the last goal of a robot that ends its service there at `cost`. A robot that waits for
/// `not_before` is not late.
double delay_at_last(const Itinerary& itinerary, double cost) {
  return late_by(itinerary.last_goal(), cost - itinerary.last_goal().service).value_or(0.0);
}

double with_cost(const Itinerary& itinerary, double delay, double cost) {
  return itinerary.weight * (delay + kShareOfCost * cost);
}

}  // namespace

std::optional<double> late_by(const Goal& goal, double t_arrive) {
  return goal.due ? std::optional(std::max(0.0, t_arrive - *goal.due)) : std::nullopt;
}

double share_of(const Itinerary& itinerary, Objective objective, const Trajectory& trajectory) {
  if (objective != Objective::tardiness) return itinerary.weight * trajectory.cost;
  const auto goal_of = [&](std::size_t number) -> const Goal& { return itinerary.goal(number); };
  double delay = total_delay(trajectory.visits, goal_of);
  delay += trajectory.stops_at ? total_delay(trajectory.estimated_visits, goal_of)
                               : delay_at_last(itinerary, trajectory.cost);
  return with_cost(itinerary, delay, trajectory.cost);
}

double least_share(const Itinerary& itinerary, Objective objective, double cost) {
  if (objective != Objective::tardiness) return itinerary.weight * cost;
  return with_cost(itinerary, delay_at_last(itinerary, cost), cost);
}

double cost_with_share(const Itinerary& itinerary, Objective objective, double share) {
  const double seconds = share / itinerary.weight;
  if (objective != Objective::tardiness) return seconds;
  const double if_in_time = seconds / kShareOfCost;
  const Goal& last = itinerary.last_goal();
  if (!last.due) return if_in_time;
  const double late_from = *last.due + last.service;
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
      const auto goal_of = [&](std::size_t number) -> const Goal& { return robot.goal_at(number); };
      value += robot.weight * (total_delay(one.visits, goal_of) + total_delay(one.estimated_visits, goal_of));
    }
  }
  return value;
}

}  // namespace fleetplan::core
