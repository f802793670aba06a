#pragma once

#include "core/prioritized/orderings.h"
#include "core/prioritized/plan_state.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// Orders robots, which have goals, by when each can be expected to come to rest for good; see
/// rank_by_time().
///
/// Nobody may pass a robot's goal while it rests there. Those who would pass later and are planned later need
/// ways around it; if they are planned before it, it cannot arrive until they have passed. So:
///
/// 1. Each robot has a way alone on the static map (CostToGo), which tells when it arrives.
/// 2. One robot after the other, the soonest first, looks whose goals its way passes after they arrive there.
///    If there are any, it chooses another way, for which its own time and what it costs others is least
///    (A*): to pass a goal costs the time for which its robot has to wait for that. Who waits already costs
///    less, so that several choose the same way.
/// 3. A robot whose goal is passed is expected afterwards, and ranks behind those who pass.
///
/// Returns `robots` if `stop` is met first, or if memory is short.
PriorityOrder order_by_expected_arrival(PlanState& state, PriorityOrder robots, const StopCondition& stop);

}  // namespace fleetplan::core
