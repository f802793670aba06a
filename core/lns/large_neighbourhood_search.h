#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "core/bounds/taut_bounds.h"
#include "core/prioritized/plan_state.h"
#include "core/runtime/executor.h"
#include "core/runtime/random.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

struct LnsResult {
  std::int64_t improvements = 0;  // how often the plan became better
  std::int64_t expansions = 0;    // labels expanded
  bool cut_off = false;           // the clock ended it
};

/// Called by the caller's thread before every round: the state follows what was found so far.
using BeforeRound = std::function<void(const LnsResult& so_far)>;

/// Makes the plan better by adaptive large neighbourhood search (Li et al., MAPF-LNS, IJCAI 2021): chooses a
/// delayed robot and some others, reroutes it at their expense, and keeps the result if the objective of the
/// options fell: the flowtime; or the makespan, or the flowtime without a longer makespan. Which robots, how
/// many, and how hard to search follows from what paid off lately by expansions, not by the clock. Ends when
/// `stop` is met, after the options' max_iterations, or when the objective is at its lower bound; `bounds`
/// has those of the movers that have a trajectory; all other robots stand at their starts for ever.
///
/// Works in rounds of a fixed number of iterations that all begin with the same plan and may run on several
/// threads of the executor; what they found is adopted in their order, unless it clashes with what was
/// adopted before in the round. So the number of threads changes nothing but the speed.
LnsResult large_neighbourhood_search(PlanState& state, const std::vector<std::size_t>& movers,
                                     const TautBounds& bounds, Random& random, Executor& executor,
                                     const StopCondition& stop, const BeforeRound& before_round = nullptr);

}  // namespace fleetplan::core
