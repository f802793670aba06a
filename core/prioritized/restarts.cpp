#include "core/prioritized/restarts.h"

#include <optional>
#include <utility>

namespace fleetplan::core {
namespace {

/// How far planning in one order got.
struct Attempt {
  PriorityOrder order;
  std::vector<Trajectory> trajectories;  // of the first robots of the order
  std::optional<std::size_t> failed;     // found no way; none if all are planned or time was up

  bool solved() const { return trajectories.size() == order.size(); }
};

/// Plans in this order until a robot finds no way; the first robot holds for a while at its start.
Attempt try_order(PlanState& state, const PriorityOrder& order, double start_delay, const StopCondition& stop,
                  ProgressReport& progress) {
  for (const std::size_t robot : order)
    state.block_start(robot, state.instance().options().start_safe_interval);
  progress.next_attempt();
  Attempt attempt{order, {}, std::nullopt};
  for (const std::size_t robot : order) {
    if (stop.met()) break;
    state.leave(robot);
    SearchResult result = state.plan(robot, {.start_delay = robot == order.front() ? start_delay : 0.0}, stop);
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

std::vector<std::size_t> restore(PlanState& state, Attempt best) {
  for (const std::size_t robot : best.order) state.leave(robot);
  const std::size_t planned = best.trajectories.size();
  for (std::size_t k = 0; k < planned; ++k) state.follow(best.order[k], std::move(best.trajectories[k]));
  return {best.order.begin() + static_cast<std::ptrdiff_t>(planned), best.order.end()};
}

class Restarts {
 public:
  Restarts(PlanState& state, PriorityOrder order, Random& random, const StopCondition& stop,
           ProgressReport& progress)
      : state_(state),
        random_(random),
        stop_(stop),
        progress_(progress),
        orders_(state.instance().options().reordering, std::move(order), random),
        best_{orders_.current(), {}, std::nullopt} {}

  RestartsResult run() {
    bool left = true;
    while (left) left = attempt(0.0) && orders_.advance(*failed_);
    // No order works. Perhaps the first robot is only too fast for the others to get out of its way.
    for (int k = 0; failed_ && k < kHolds; ++k) {
      orders_.shuffle();
      if (!attempt(random_start_delay(state_.instance(), orders_.current(), random_))) break;
    }
    result_.unsolved = restore(state_, std::move(best_));
    return std::move(result_);
  }

 private:
  static constexpr int kHolds = 40;

  /// True if a robot failed, and all may be tried again.
  bool attempt(double start_delay) {
    ++result_.attempts;
    Attempt attempt = try_order(state_, orders_.current(), start_delay, stop_, progress_);
    const bool first_failed = attempt.failed && attempt.trajectories.empty() && start_delay == 0.0;
    failed_ = attempt.failed;
    result_.cut_off = !failed_ && !attempt.solved();
    if (first_failed) {  // not even alone with those that stay: it stays as well
      result_.given_up.push_back(*failed_);
      orders_.drop(*failed_);
      state_.stand_for_ever(*failed_);
      best_ = {orders_.current(), {}, std::nullopt};
      return this->attempt(0.0);
    }
    if (attempt.trajectories.size() >= best_.trajectories.size()) best_ = std::move(attempt);
    return failed_.has_value();
  }

  PlanState& state_;
  Random& random_;
  const StopCondition& stop_;
  ProgressReport& progress_;
  OrderSequence orders_;
  Attempt best_;
  std::optional<std::size_t> failed_;
  RestartsResult result_;
};

}  // namespace

RestartsResult plan_with_restarts(PlanState& state, PriorityOrder order, Random& random,
                                  const StopCondition& stop, ProgressReport& progress) {
  return Restarts(state, std::move(order), random, stop, progress).run();
}

}  // namespace fleetplan::core
