#include "core/prioritized/prioritized_planning.h"

#include <utility>

#include "core/prioritized/ordering_result.h"
#include "core/prioritized/partial_plan.h"
#include "core/prioritized/repair_or_restart.h"
#include "core/prioritized/restarts.h"

namespace fleetplan::core {
namespace {

/// For at most so many robots all orders are tried: unlike repair, that ends where there is no solution and
/// proves it for prioritized planning.
constexpr std::size_t kFewRobots = 4;

/// Plans every robot once, in this order.
OrderingResult plan_each_once(PlanState& state, const PriorityOrder& order, const StopCondition& stop,
                              ProgressReport& progress) {
  progress.next_attempt();
  const double reserved = state.instance().options().start_safe_interval;
  OrderingResult result;
  for (const std::size_t robot : order) state.reserve_start(robot, reserved);
  for (const std::size_t robot : order) {
    SearchResult search;
    state.remove(robot);
    if (!stop.met()) search = state.plan(robot, {}, stop);
    if (search.trajectory) {
      state.follow(robot, std::move(*search.trajectory));
      progress.update();
    } else {
      state.reserve_start(robot, reserved);
      result.unsolved.push_back(robot);
    }
  }
  result.cut_off = stop.met();
  return result;
}

OrderingResult plan_in_orders(PlanState& state, const PriorityOrder& order, Random& random,
                              const StopCondition& stop, ProgressReport& progress) {
  const auto reordering = state.instance().options().reordering;
  if (reordering == PlanOptions::Reordering::none) return plan_each_once(state, order, stop, progress);
  if (reordering == PlanOptions::Reordering::random || order.size() <= kFewRobots) {
    return plan_with_restarts(state, order, random, stop, progress);
  }
  return repair_or_restart(state, order, random, stop, progress);
}

PrioritizedResult all_unplanned(const std::vector<std::size_t>& movers) {
  PrioritizedResult result;
  result.cut_off = true;
  for (const std::size_t robot : movers) {
    result.unplanned.push_back({robot,
                                Unplanned::Reason::budget_exhausted,
                                "The time budget ended before planning could begin.",
                                {}});
  }
  return result;
}

}  // namespace

PrioritizedResult plan_prioritized(PlanState& state, const std::vector<std::size_t>& movers, Random& random,
                                   const StopCondition& stop_attempts, const StopCondition& stop,
                                   ProgressReport& progress) {
  if (stop.met()) return all_unplanned(movers);
  const PriorityOrder order = initial_order(state.instance(), movers, random);
  const OrderingResult ordering = plan_in_orders(state, order, random, stop_attempts, progress);
  PrioritizedResult result{{}, ordering.attempts, ordering.cut_off};
  if (ordering.unsolved.empty() && ordering.given_up.empty()) return result;
  PartialPlan partial = make_partial_plan(state, ordering.unsolved, ordering.given_up, stop, progress);
  result.cut_off = result.cut_off || partial.cut_off;
  result.unplanned = std::move(partial.unplanned);
  return result;
}

}  // namespace fleetplan::core
