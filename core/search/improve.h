#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/search/fleet_state.h"
#include "core/search/random.h"
#include "core/search/stop_condition.h"
#include "core/search/taut_bounds.h"

namespace fleetplan::core {

struct Improvement {
  std::int64_t improvements = 0;  // how often the plan became better
  bool cut_off = false;           // the clock ended it
};

/// Makes the plan better by large neighbourhood search (Li et al., MAPF-LNS, IJCAI 2021): takes the
/// trajectories of a few robots back, plans them again in another order, and keeps the result only if the
/// objective of the options fell. Ends when `stop` is met, after the options' max_iterations, or when every
/// robot costs its lower bound, of which `bounds` has those of the movers that have a trajectory.
Improvement improve(FleetState& state, const std::vector<std::size_t>& movers, const TautBounds& bounds,
                    Random& random, const StopCondition& stop);

}  // namespace fleetplan::core
