#include "core/search/prioritized.h"

#include <utility>

#include "core/search/complete.h"
#include "core/search/repair.h"
#include "core/search/restarts.h"

namespace fleetplan::core {
namespace {

/// Up to so many robots all orders are tried rather than repaired: it ends, and says so, where there is no
/// solution.
constexpr std::size_t kFewRobots = 4;

/// Robots without a trajectory, and those among them that have no way even alone with the robots that stay.
struct Rest {
  std::vector<std::size_t> unsolved;
  std::vector<std::size_t> hopeless;
};

Rest solve(FleetState& state, const PriorityOrder& order, Random& random, const StopCondition& stop,
           PrioritizedResult& result) {
  const auto reordering = state.fleet().options().reordering;
  if (reordering == PlanOptions::Reordering::none) return {order, {}};
  if (reordering == PlanOptions::Reordering::random || order.size() <= kFewRobots) {
    RestartsResult restarts = plan_with_restarts(state, order, random, stop);
    result.attempts = restarts.attempts;
    result.cut_off = restarts.cut_off;
    return {std::move(restarts.unsolved), std::move(restarts.hopeless)};
  }
  RepairResult repair = plan_with_repair(state, order, random, stop);
  result.attempts = repair.attempts;
  result.cut_off = !repair.unsolved.empty();
  return {std::move(repair.unsolved), std::move(repair.hopeless)};
}

}  // namespace

PrioritizedResult plan_prioritized(FleetState& state, const std::vector<std::size_t>& movers, Random& random,
                                   const StopCondition& attempts_stop, const StopCondition& stop) {
  PrioritizedResult result;
  const Rest rest = solve(state, initial_order(state.fleet(), movers, random), random, attempts_stop, result);
  if (rest.unsolved.empty() && rest.hopeless.empty()) return result;
  ++result.attempts;
  Completion completion = complete(state, rest.unsolved, rest.hopeless, stop);
  result.cut_off = result.cut_off || completion.cut_off;
  result.unplanned = std::move(completion.unplanned);
  return result;
}

}  // namespace fleetplan::core
