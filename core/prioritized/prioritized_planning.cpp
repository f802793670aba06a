#include "core/prioritized/prioritized_planning.h"

#include <utility>

#include "core/prioritized/partial_plan.h"
#include "core/prioritized/repair.h"
#include "core/prioritized/restarts.h"

namespace fleetplan::core {
namespace {

/// Up to so many robots all orders are tried rather than repaired: it ends, and says so, where there is no
/// solution.
constexpr std::size_t kFewRobots = 4;

/// Robots without a trajectory: those to plan once more, and those that stand at their starts for ever
/// already.
struct Rest {
  std::vector<std::size_t> unsolved;
  std::vector<std::size_t> given_up;
};

/// Plans every robot once, in this order; returns those that found no way.
std::vector<std::size_t> plan_each_once(PlanState& state, const PriorityOrder& order,
                                        const StopCondition& stop, ProgressReport& progress) {
  progress.next_attempt();
  const double blocked = state.instance().options().start_safe_interval;
  std::vector<std::size_t> unsolved;
  for (const std::size_t robot : order) state.block_start(robot, blocked);
  for (const std::size_t robot : order) {
    SearchResult result;
    state.leave(robot);
    if (!stop.met()) result = state.plan(robot, {}, stop);
    if (result.trajectory) {
      state.follow(robot, std::move(*result.trajectory));
      progress.update();
    } else {
      state.block_start(robot, blocked);
      unsolved.push_back(robot);
    }
  }
  return unsolved;
}

Rest solve(PlanState& state, const PriorityOrder& order, Random& random, const StopCondition& patience,
           ProgressReport& progress, PrioritizedResult& result) {
  const auto reordering = state.instance().options().reordering;
  if (reordering == PlanOptions::Reordering::none) {
    result.attempts = 1;
    Rest rest{plan_each_once(state, order, patience, progress), {}};
    result.cut_off = patience.met();
    return rest;
  }
  if (reordering == PlanOptions::Reordering::random || order.size() <= kFewRobots) {
    RestartsResult restarts = plan_with_restarts(state, order, random, patience, progress);
    result.attempts = restarts.attempts;
    result.cut_off = restarts.cut_off;
    return {std::move(restarts.unsolved), std::move(restarts.given_up)};
  }
  RepairResult repair = plan_with_repair(state, order, random, patience, progress);
  result.attempts = repair.attempts;
  result.cut_off = !repair.unsolved.empty();
  return {std::move(repair.unsolved), std::move(repair.given_up)};
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
                                   const StopCondition& patience, const StopCondition& stop,
                                   ProgressReport& progress) {
  PrioritizedResult result;
  if (stop.met()) return all_unplanned(movers);
  const Rest rest =
      solve(state, initial_order(state.instance(), movers, random), random, patience, progress, result);
  if (rest.unsolved.empty() && rest.given_up.empty()) return result;
  PartialPlan completion = make_partial_plan(state, rest.unsolved, rest.given_up, stop, progress);
  result.cut_off = result.cut_off || completion.cut_off;
  result.unplanned = std::move(completion.unplanned);
  return result;
}

}  // namespace fleetplan::core
