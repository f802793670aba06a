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

/// Orders robots, which have goals, by when each is expected to come to rest for good; see rank_by_time().
///
/// A robot that rests at its goal blocks it for all others. Robots that pass later, and are planned later,
/// need ways around it. If they are planned before it, it cannot arrive until they have passed. So:
///
/// 1. Each robot has a way alone on the static map (CostToGo), which gives its arrival.
/// 2. One robot after the other, the soonest first, looks for goals that its way passes after their robots
///    have arrived. If there is no room beside these goals, it chooses the way of least cost (A*): its own
///    time, plus the delay of other robots. Passing a goal delays the goal's robot until the passage. A robot
///    that waits already adds less delay, so several robots choose the same way.
/// 3. A robot whose goal is passed is expected after the passage. It ranks behind the robots that pass,
///    except where they wait for it in turn.
///
/// If the search spaces of all robots need too much memory, `robots` stay in their order, or no more ways are
/// chosen.
ExpectedOrder order_by_expected_arrival(PlanState& state, const PriorityOrder& robots,
                                        const StopCondition& stop);

}  // namespace fleetplan::core
