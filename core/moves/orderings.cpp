#include "core/moves/orderings.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "core/bounds/lower_bound.h"
#include "core/model/itinerary.h"

namespace fleetplan::core {
namespace {

/// Returns the number of orders of `count` robots, or `limit` if that is less.
std::size_t permutations(std::size_t count, std::size_t limit) {
  std::size_t product = 1;
  for (std::size_t i = 2; i <= count && product < limit; ++i) product *= i;
  return std::min(product, limit);
}

/// Moves robots that have arrived to the end, and the robot whose goal is the oldest to the front.
void order_for_horizon(const std::vector<Itinerary>& all, PriorityOrder& order) {
  // No search fails that may end with a wait, so no robot would be raised above one in its way for good.
  const auto end = std::stable_partition(order.begin(), order.end(),
                                         [&](auto i) { return all[i].yields() || !has_arrived(all[i]); });
  const auto oldest = std::min_element(order.begin(), end, [&](auto a, auto b) {
    return std::tuple(-all[a].goal_age, -all[a].weight, a) < std::tuple(-all[b].goal_age, -all[b].weight, b);
  });
  if (oldest != end && all[*oldest].goal_age > 0.0) std::rotate(order.begin(), oldest, oldest + 1);
}

/// A time of a robot as it counts for its rank: half way between time and distance. In the paper's halls that
/// gave the cheapest first solutions; travel time fails more often in crowds.
double with_speed_weight(const Itinerary& itinerary, double seconds) {
  return seconds * std::sqrt(itinerary.load.linear_speed);
}

}  // namespace

double rank_by_time(const Itinerary& itinerary, double seconds) {
  return with_speed_weight(itinerary, seconds) / itinerary.weight;
}

PriorityOrder initial_order(const Instance& instance, std::vector<std::size_t> robots, Random& random) {
  return initial_order(instance.itineraries(), instance.options(), std::move(robots), random);
}

PriorityOrder initial_order(const std::vector<Itinerary>& all, const PlanOptions& options,
                            std::vector<std::size_t> robots, Random& random) {
  const auto straight = [&](std::size_t i) { return all[i].direct_way / all[i].load.linear_speed; };
  switch (options.priority) {
    case PlanOptions::Priority::shortest_first:
      std::stable_sort(robots.begin(), robots.end(), [&](auto a, auto b) {
        return rank_by_time(all[a], straight(a)) < rank_by_time(all[b], straight(b));
      });
      if (options.horizon) order_for_horizon(all, robots);
      break;
    case PlanOptions::Priority::longest_first:
      std::stable_sort(robots.begin(), robots.end(), [&](auto a, auto b) {
        return with_speed_weight(all[a], straight(a)) * all[a].weight >
               with_speed_weight(all[b], straight(b)) * all[b].weight;
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

double random_start_delay(const Instance& instance, const PriorityOrder& order, Random& random) {
  const std::size_t other = order[random.below(order.size())];
  const Itinerary& itinerary = instance.itinerary(other);
  const std::vector<Body> bodies = instance.views(other).bodies(itinerary.goals.size());
  return random.unit() * lower_bound(itinerary, bodies);
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

namespace {

/// Orders that are tried with a start delay after all orders have failed without one.
constexpr int kDelayedOrders = 40;

/// The result of planning in one order.
struct Attempt {
  PriorityOrder order;
  std::vector<Trajectory> trajectories;  // trajectories of the first robots of the order
  std::optional<std::size_t> failed;  // the robot without a path; none if all are planned or it was stopped

  bool solved() const { return trajectories.size() == order.size(); }
};

/// Plans in this order until a robot fails; the first robot starts after `start_delay` seconds.
Attempt try_order(PlanState& state, const PriorityOrder& order, double start_delay, const StopCondition& stop,
                  ProgressReport& progress) {
  FleetReservations& reservations = state.reservations();
  const double reserved = state.instance().options().start_safe_interval;
  for (const std::size_t robot : order) reservations.reserve_place(robot, reserved);
  progress.next_attempt();
  Attempt attempt{order, {}, std::nullopt};
  for (const std::size_t robot : order) {
    if (stop.met()) break;
    reservations.remove(robot);
    const double delay = robot == order.front() ? start_delay : 0.0;
    SearchResult result = state.plan(robot, {.start_delay = delay}, stop);
    if (!result.trajectory) {
      if (result.complete) attempt.failed = robot;
      break;
    }
    attempt.trajectories.push_back(*result.trajectory);
    reservations.follow(robot, std::move(*result.trajectory));
    progress.update();
  }
  return attempt;
}

/// Restores the reservations of an attempt. Returns the robots without a trajectory.
std::vector<std::size_t> restore(FleetReservations& reservations, Attempt best) {
  for (const std::size_t robot : best.order) reservations.remove(robot);
  const std::size_t planned = best.trajectories.size();
  for (std::size_t k = 0; k < planned; ++k)
    reservations.follow(best.order[k], std::move(best.trajectories[k]));
  return {best.order.begin() + static_cast<std::ptrdiff_t>(planned), best.order.end()};
}

class Restarts {
 public:
  Restarts(PlanState& state, PriorityOrder order, Random& random, const StopCondition& stop,
           ProgressReport& progress, const OnStop& on_stop)
      : state_(state),
        random_(random),
        stop_(stop),
        progress_(progress),
        on_stop_(on_stop),
        orders_(state.instance().options().reordering, std::move(order), random),
        best_{orders_.current(), {}, std::nullopt} {
    result_.attempts = 0;
  }

  OrderingResult run() {
    while (attempt(0.0) && orders_.advance(*failed_)) {
    }
    // All orders failed. The first robot may only be too fast for the others to get out of its way.
    for (int k = 0; failed_ && k < kDelayedOrders; ++k) {
      orders_.shuffle();
      if (!attempt(random_start_delay(state_.instance(), orders_.current(), random_))) break;
    }
    result_.unsolved = restore(state_.reservations(), std::move(best_));
    return std::move(result_);
  }

 private:
  /// Plans in the present order. Returns whether a robot failed.
  bool attempt(double start_delay) {
    ++result_.attempts;
    Attempt attempt = try_order(state_, orders_.current(), start_delay, stop_, progress_);
    const bool first_failed = attempt.failed && attempt.trajectories.empty() && start_delay == 0.0;
    failed_ = attempt.failed;
    result_.cut_off = !failed_ && !attempt.solved();
    if (first_failed) {  // no path even among the robots that stay
      give_up(*failed_);
      return this->attempt(0.0);
    }
    if (attempt.trajectories.size() >= best_.trajectories.size()) best_ = std::move(attempt);
    if (result_.cut_off && on_stop_) {
      result_.unsolved = restore(state_.reservations(), best_);
      if (on_stop_(result_)) return this->attempt(start_delay);
    }
    return failed_.has_value();
  }

  void give_up(std::size_t robot) {
    result_.given_up.push_back(robot);
    result_.hopeless.push_back(robot);
    orders_.drop(robot);
    state_.reservations().stay_in_place(robot);
    best_ = {orders_.current(), {}, std::nullopt};
  }

  PlanState& state_;
  Random& random_;
  const StopCondition& stop_;
  ProgressReport& progress_;
  const OnStop& on_stop_;
  OrderSequence orders_;
  Attempt best_;
  std::optional<std::size_t> failed_;
  OrderingResult result_;
};

}  // namespace

OrderingResult plan_with_restarts(PlanState& state, PriorityOrder order, Random& random,
                                  const StopCondition& stop, ProgressReport& progress,
                                  const OnStop& on_stop) {
  return Restarts(state, std::move(order), random, stop, progress, on_stop).run();
}

}  // namespace fleetplan::core
