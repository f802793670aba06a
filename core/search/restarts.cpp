#include "core/search/restarts.h"

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

Attempt try_order(FleetState& state, const PriorityOrder& order, const StopCondition& stop) {
  for (const std::size_t robot : order) state.block_start(robot, state.fleet().options().start_safe_interval);
  Attempt attempt{order, {}, std::nullopt};
  for (const std::size_t robot : order) {
    state.leave(robot);
    SearchResult result = state.plan(robot, {}, stop);
    if (!result.trajectory) {
      if (result.complete) attempt.failed = robot;
      break;
    }
    attempt.trajectories.push_back(*result.trajectory);
    state.follow(robot, std::move(*result.trajectory));
  }
  return attempt;
}

std::vector<std::size_t> restore(FleetState& state, Attempt best) {
  for (const std::size_t robot : best.order) state.leave(robot);
  const std::size_t planned = best.trajectories.size();
  for (std::size_t k = 0; k < planned; ++k) state.follow(best.order[k], std::move(best.trajectories[k]));
  return {best.order.begin() + static_cast<std::ptrdiff_t>(planned), best.order.end()};
}

}  // namespace

RestartsResult plan_with_restarts(FleetState& state, PriorityOrder order, Random& random,
                                  const StopCondition& stop) {
  RestartsResult result;
  OrderSequence orders(state.fleet().options().reordering, std::move(order), random);
  Attempt best{orders.current(), {}, std::nullopt};
  while (true) {
    ++result.attempts;
    Attempt attempt = try_order(state, orders.current(), stop);
    const std::optional<std::size_t> failed = attempt.failed;
    const bool first_failed = failed && attempt.trajectories.empty();
    result.cut_off = !failed && !attempt.solved();
    if (attempt.trajectories.size() >= best.trajectories.size()) best = std::move(attempt);
    if (!failed) break;
    if (first_failed) {  // not even alone with those that stay: it stays as well
      result.given_up.push_back(*failed);
      orders.drop(*failed);
      state.stand_for_ever(*failed);
      best = {orders.current(), {}, std::nullopt};
    } else if (!orders.advance(*failed)) {
      break;
    }
  }
  result.unsolved = restore(state, std::move(best));
  return result;
}

}  // namespace fleetplan::core
