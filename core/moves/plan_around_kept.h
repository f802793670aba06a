#pragma once

// Prioritized planning of all robots around plans that are kept.

#include <cstddef>
#include <vector>

#include "core/fleet/plan_state.h"
#include "core/fleet/progress_report.h"
#include "core/moves/prioritized_planning.h"
#include "core/runtime/random.h"

namespace fleetplan::core {

/// Plans the robots of `movers` (ascending) that have no trajectory in `state` around the robots that have
/// one.
///
/// Robots with a trajectory keep it unless another robot cannot be planned otherwise. Then the plan is
/// repaired (see repair.h). If that does not plan all robots, a new plan is made, and used if it plans more
/// robots.
///
/// Some robots can follow their trajectories while all other `movers` stay where they are. These robots
/// remain planned in every case, even if `time` is over before planning begins. `certain` marks them, by
/// robot. If it is empty, they are the robots that cross no place where another robot may have to stay.
/// Leaves the best safe plan in the state.
PrioritizedResult plan_around_kept(PlanState& state, const std::vector<std::size_t>& movers,
                                   const std::vector<bool>& certain, Random& random, const PlanningTime& time,
                                   ProgressReport& progress);

}  // namespace fleetplan::core
