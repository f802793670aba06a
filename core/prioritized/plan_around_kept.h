#pragma once

#include <cstddef>
#include <vector>

#include "core/prioritized/plan_state.h"
#include "core/prioritized/prioritized_planning.h"
#include "core/prioritized/progress_report.h"
#include "core/runtime/random.h"

namespace fleetplan::core {

/// Plans those of `movers` (ascending) that follow no trajectory in `state` around those that do. These keep
/// their trajectories unless another robot cannot be planned otherwise: then the plan is repaired (see
/// orderings.h), and if that does not plan all, made anew if that plans more.
///
/// Robots that can follow their trajectories while all others of `movers` stay where they are remain planned
/// in every case, also if `time` is over before planning begins: those of which `certain` (by robot, may be
/// empty) says so, or if it says so of none, those that cross no other. Leaves the best safe plan in the
/// state.
PrioritizedResult plan_around_kept(PlanState& state, const std::vector<std::size_t>& movers,
                                   const std::vector<bool>& certain, Random& random, const PlanningTime& time,
                                   ProgressReport& progress);

}  // namespace fleetplan::core
