#include "core/prioritized/priority_order.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "core/bounds/lower_bound.h"
#include "core/model/itinerary.h"

namespace fleetplan::core {
namespace {

/// The influence of speed on a robot's rank: 0 to sort by distance, 1 to sort by travel time. In the paper's
/// halls a quarter gave the cheapest first solutions; travel time fails more often in crowds.
constexpr double kSpeedWeight = 0.25;

/// Returns the number of orders of `count` robots, or `limit` if that is less.
std::size_t permutations(std::size_t count, std::size_t limit) {
  std::size_t product = 1;
  for (std::size_t i = 2; i <= count && product < limit; ++i) product *= i;
  return std::min(product, limit);
}

/// Moves robots that have arrived to the end, and the one whose goal is the oldest to the front.
void order_for_horizon(const std::vector<Robot>& all, PriorityOrder& order) {
  // No search fails that may end with a wait, so no robot would be raised above one in its way for good.
  const auto end = std::stable_partition(order.begin(), order.end(),
                                         [&](auto i) { return all[i].yields() || !has_arrived(all[i]); });
  const auto oldest = std::min_element(order.begin(), end, [&](auto a, auto b) {
    return std::tuple(-all[a].goal_age, -all[a].weight, a) < std::tuple(-all[b].goal_age, -all[b].weight, b);
  });
  if (oldest != end && all[*oldest].goal_age > 0.0) std::rotate(order.begin(), oldest, oldest + 1);
}

/// Along straight lines from goal to goal, metres.
double distance_to_goals(const Robot& robot) {
  double distance = 0.0;
  Position from = robot.committed_end().position;
  for (const Goal& goal : robot.via) {
    distance += (goal.position - from).norm();
    from = goal.position;
  }
  return distance + (robot.goal->position - from).norm();
}

/// The distance over the speed to this power.
double weighted_distance(const Robot& robot, double speed_weight) {
  return distance_to_goals(robot) / std::pow(robot.linear_speed, speed_weight);
}

/// The nearest to their goals first. A heavy robot counts as so many times nearer (Smith's rule, 1956).
PriorityOrder sorted_by_distance(const std::vector<Robot>& all, PriorityOrder robots, double speed_weight) {
  const auto key = [&](std::size_t i) { return weighted_distance(all[i], speed_weight) / all[i].weight; };
  std::stable_sort(robots.begin(), robots.end(), [&](auto a, auto b) { return key(a) < key(b); });
  return robots;
}

}  // namespace

PriorityOrder order_by_time(const Instance& instance, std::vector<std::size_t> robots) {
  return sorted_by_distance(instance.problem().robots(), std::move(robots), 1.0);
}

PriorityOrder initial_order(const Instance& instance, std::vector<std::size_t> robots, Random& random) {
  return initial_order(instance.problem().robots(), instance.options(), std::move(robots), random);
}

PriorityOrder initial_order(const std::vector<Robot>& all, const PlanOptions& options,
                            std::vector<std::size_t> robots, Random& random) {
  switch (options.priority) {
    case PlanOptions::Priority::shortest_first:
      robots = sorted_by_distance(all, std::move(robots), kSpeedWeight);
      if (options.horizon) order_for_horizon(all, robots);
      break;
    case PlanOptions::Priority::longest_first:
      std::stable_sort(robots.begin(), robots.end(), [&](auto a, auto b) {
        return weighted_distance(all[a], kSpeedWeight) * all[a].weight >
               weighted_distance(all[b], kSpeedWeight) * all[b].weight;
      });
      break;
    case PlanOptions::Priority::random:
      random.shuffle(robots);
      break;
    case PlanOptions::Priority::as_listed:
      break;
  }
  return robots;
}

bool differ_in_size(const Instance& instance, const PriorityOrder& order) {
  return std::any_of(order.begin(), order.end(), [&](std::size_t robot) {
    return instance.motion(robot).pair_radius != instance.motion(order.front()).pair_radius;
  });
}

double random_start_delay(const Instance& instance, const PriorityOrder& order, Random& random) {
  const std::size_t other = order[random.below(order.size())];
  return random.unit() * lower_bound(instance.robot(other), instance.options());
}

OrderSequence::OrderSequence(PlanOptions::Reordering reordering, PriorityOrder first, Random& random)
    : reordering_(reordering), current_(std::move(first)), random_(random) {
  mark_tried();
}

bool OrderSequence::advance(std::size_t failed) {
  if (reordering_ == PlanOptions::Reordering::none) return false;
  if (reordering_ == PlanOptions::Reordering::raise_failed) {
    const auto position = std::find(current_.begin(), current_.end(), failed);
    std::rotate(current_.begin(), position, position + 1);
    if (mark_tried()) return true;
  }
  const std::size_t all = permutations(current_.size(), tried_.size() + 1);
  while (tried_.size() < all) {
    random_.shuffle(current_);
    if (mark_tried()) return true;
  }
  return false;
}

void OrderSequence::drop(std::size_t robot) {
  std::erase(current_, robot);
  tried_.clear();
  mark_tried();
}

}  // namespace fleetplan::core
