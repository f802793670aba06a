#pragma once

#include "core/fleet/plan_state.h"
#include "core/moves/orderings.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// Robots in the order of their expected arrivals.
struct ExpectedOrder {
  PriorityOrder robots;
  bool cut_off = false;  // the stop condition was met before all was considered
};

/// Orders robots, which have goals, by when each can be expected to come to rest for good; see
/// rank_by_time().
///
/// Nobody may pass a robot's goal while it rests there. Those who would pass later and are planned later need
/// ways around it; if they are planned before it, it cannot arrive until they have passed. So:
///
/// 1. Each robot has a way alone on the static map (CostToGo), which tells when it arrives.
/// 2. One robot after the other, the soonest first, looks whose goals its way passes after they arrive there.
///    Unless there is room beside those goals, it chooses another way, for which its own time and what it
///    costs others is least (A*): to pass a goal costs the time for which its robot has to wait for that. Who
///    waits already costs less, so that several choose the same way.
/// 3. A robot whose goal is passed is expected afterwards, and ranks behind those who pass, except where
///    these wait for it in turn.
///
/// Where the search spaces of all robots are too much to keep, `robots` stay in their order, or no more ways
/// are chosen.
ExpectedOrder order_by_expected_arrival(PlanState& state, const PriorityOrder& robots,
                                        const StopCondition& stop);

}  // namespace fleetplan::core
