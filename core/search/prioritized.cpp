#include "core/search/prioritized.h"

#include <algorithm>
#include <utility>

#include "core/search/complete.h"

namespace fleetplan::core {
namespace {

/// How far planning in one order got.
struct Attempt {
  std::size_t planned = 0;            // so many of the order have a trajectory
  std::optional<std::size_t> failed;  // found no way; none if all are planned or time was up
  std::vector<Trajectory> trajectories;
};

/// Plans in this order until a robot finds no way.
Attempt try_order(FleetState& state, const PriorityOrder& order, const StopCondition& stop) {
  for (const std::size_t robot : order) state.block_start(robot, state.fleet().options().start_safe_interval);
  Attempt attempt;
  for (const std::size_t robot : order) {
    state.leave(robot);
    SearchResult result = state.plan(robot, {}, stop);
    if (!result.trajectory) {
      if (result.complete) attempt.failed = robot;
      break;
    }
    attempt.trajectories.push_back(*result.trajectory);
    state.follow(robot, std::move(*result.trajectory));
    ++attempt.planned;
  }
  return attempt;
}

/// The attempt that got farthest, to go on from.
struct Best {
  PriorityOrder order;
  std::vector<Trajectory> trajectories;
};

void restore(FleetState& state, Best best) {
  for (const std::size_t robot : best.order) state.leave(robot);
  for (std::size_t k = 0; k < best.trajectories.size(); ++k) {
    state.follow(best.order[k], std::move(best.trajectories[k]));
  }
}

}  // namespace

PrioritizedResult plan_prioritized(FleetState& state, const std::vector<std::size_t>& movers, Random& random,
                                   const StopCondition& attempts_stop, const StopCondition& stop) {
  PrioritizedResult result;
  const auto reordering = state.fleet().options().reordering;
  OrderSequence orders(reordering, initial_order(state.fleet(), movers, random), random);
  std::vector<std::size_t> hopeless;
  Best best{orders.current(), {}};
  while (reordering != PlanOptions::Reordering::none) {
    ++result.attempts;
    Attempt attempt = try_order(state, orders.current(), attempts_stop);
    if (attempt.planned == orders.current().size() && hopeless.empty()) return result;
    if (attempt.planned >= best.trajectories.size())
      best = {orders.current(), std::move(attempt.trajectories)};
    if (attempt.planned == orders.current().size()) break;
    if (!attempt.failed) {
      result.cut_off = true;
      break;
    }
    if (attempt.planned == 0) {  // not even alone with those that stay: it stays as well
      hopeless.push_back(*attempt.failed);
      orders.drop(*attempt.failed);
      state.stand_for_ever(*attempt.failed);
      best = {orders.current(), {}};
    } else if (!orders.advance(*attempt.failed)) {
      break;
    }
  }
  restore(state, std::move(best));
  Completion completion = complete(state, orders.current(), hopeless, stop);
  result.attempts += 1;
  result.cut_off = result.cut_off || completion.cut_off;
  result.unplanned = std::move(completion.unplanned);
  return result;
}

}  // namespace fleetplan::core
