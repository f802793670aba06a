#include <optional>
#include <utility>
#include <vector>

#include "core/prioritized/orderings.h"

namespace fleetplan::core {
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
  const double reserved = state.instance().options().start_safe_interval;
  for (const std::size_t robot : order) state.reserve_start(robot, reserved);
  progress.next_attempt();
  Attempt attempt{order, {}, std::nullopt};
  for (const std::size_t robot : order) {
    if (stop.met()) break;
    state.remove(robot);
    const double delay = robot == order.front() ? start_delay : 0.0;
    SearchResult result = state.plan(robot, {.start_delay = delay}, stop);
    if (!result.trajectory) {
      if (result.complete) attempt.failed = robot;
      break;
    }
    attempt.trajectories.push_back(*result.trajectory);
    state.follow(robot, std::move(*result.trajectory));
    progress.update();
  }
  return attempt;
}

/// Restores the state of an attempt. Returns the robots without a trajectory.
std::vector<std::size_t> restore(PlanState& state, Attempt best) {
  for (const std::size_t robot : best.order) state.remove(robot);
  const std::size_t planned = best.trajectories.size();
  for (std::size_t k = 0; k < planned; ++k) state.follow(best.order[k], std::move(best.trajectories[k]));
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
    result_.unsolved = restore(state_, std::move(best_));
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
    if (result_.cut_off && on_stop_ && on_stop_(restore(state_, best_), result_.given_up)) {
      return this->attempt(start_delay);
    }
    return failed_.has_value();
  }

  void give_up(std::size_t robot) {
    result_.given_up.push_back(robot);
    orders_.drop(robot);
    state_.stay_at_start(robot);
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
