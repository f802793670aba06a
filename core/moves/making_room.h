#pragma once

// Room for two: where two robots meet, both move aside.

#include <cstddef>
#include <vector>

#include "core/compile/views.h"
#include "core/fleet/plan_state.h"
#include "core/fleet/progress_report.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// Plans a few robots if each of them blocks another, whatever their order. In a corridor, for example, the
/// robot that is planned first takes the middle.
///
/// It takes the ways of two robots alone on the map. Where they meet, or near there along the way, each robot
/// passes through a place on a different side. If the second robot has no way then, the first one waits in
/// its place until the second one has passed. The other robots are planned after both. At last, each robot is
/// planned again as long as it costs less.
///
/// Only robots with one load move aside. Returns whether all of `robots` follow a trajectory; if not, no
/// reservation has changed. The effort of each search is limited.
bool make_room(PlanState& state, const std::vector<std::size_t>& robots, const StopCondition& stop,
               ProgressReport& progress);

/// How far a robot that fits at a place may go straight from there, in metres, up to `max`. `direction` has
/// length 1.
double room_towards(const View& view, const Position& from, const Position& direction, double max);

/// Plans each of these robots, which follow trajectories, again as long as that costs less. A few times at
/// most.
void replan_for_less(PlanState& state, const std::vector<std::size_t>& robots, const StopCondition& stop);

}  // namespace fleetplan::core
