#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "core/bounds/taut_path_bounds.h"
#include "core/fleet/plan_state.h"
#include "core/runtime/executor.h"
#include "core/runtime/random.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

struct LnsResult {
  std::int64_t improvements = 0;  // times that the plan became better
  std::int64_t expansions = 0;    // labels expanded
  bool cut_off = false;           // the stop condition or the executor ended it, or the time began its end
  bool exhausted = false;         // nothing is left to try: no robot can become cheaper
};

/// Called by the caller's thread before every round, with the state updated to the best plan.
using BeforeRound = std::function<void(const LnsResult& so_far)>;

/// Improves the plan by adaptive large neighbourhood search (Li et al., MAPF-LNS, IJCAI 2021; Ropke and
/// Pisinger, 2006). An iteration
///
/// 1. chooses a delayed robot, the neighbourhood, its size and the search effort by their recent success,
/// 2. selects the robots of the neighbourhood,
/// 3. plans them again (see neighbourhood.h), and
/// 4. accepts the change if the objective falls (see objective_share.h).
///
/// The objective is the flowtime or the tardiness. For the makespan, a lower flowtime without a longer
/// makespan is accepted, too. A sum may also rise a little, which leads out of local optima (threshold
/// accepting; Dueck and Scheuer, 1990). The best plan is kept (see incumbent.h).
///
/// Success is measured per expansion, not per second. In the last tenth of the time, or of the options'
/// max_iterations, iterations smooth one robot after the other, without searches. Only robots of `movers`
/// that have a trajectory are planned again; `bounds` has their lower bounds. All other robots keep their
/// trajectories, or stay at their starts.
///
/// The search ends when `stop` is met, after the options' max_iterations, or when nothing is left to try:
///
/// - the objective is equal to its lower bound,
/// - or no delayed robot has a cheaper path, even if it is alone with the robots that stay. This is tested,
///   robot by robot, while iterations gain nothing (see iterations.h).
///
/// A few iterations overlap (see pipeline.h), on any number of threads of the executor. Each begins with the
/// incumbent after the iteration a fixed number before it. Changes are accepted in order, unless they
/// conflict with a change accepted meanwhile. So the number of threads changes only the speed. The executor
/// may make the search wait, which takes time and changes nothing else, or end it (see
/// Executor::may_improve).
///
/// A round is a fixed number of iterations. At its end, threads wait for each other. Vertices get more
/// neighbours (WorkspacePool::add_moves) after some iterations for each robot, and again after more
/// iterations. They get them sooner if nothing else is left to try.
LnsResult large_neighbourhood_search(PlanState& state, const std::vector<std::size_t>& movers,
                                     const TautPathBounds& bounds, Random& random, Executor& executor,
                                     const StopCondition& stop, const BeforeRound& before_round = nullptr);

}  // namespace fleetplan::core
