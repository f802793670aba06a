#pragma once

// The plan of all robots: their trajectories as actions. For robots that stop at the horizon, also when they
// would arrive at the goals that are left.

#include <optional>
#include <vector>

#include "core/bounds/taut_path_bounds.h"
#include "core/fleet/plan_state.h"
#include "core/model/drive_zones.h"
#include "core/model/plan.h"
#include "core/model/robot.h"
#include "core/model/trajectory.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// Returns the plan that is reserved, without search statistics. Every robot is unplanned, follows its
/// trajectory, or is parked. `unplanned` is by robot.
Plan collect_plan(const FleetReservations& reservations,
                  const std::vector<std::optional<Unplanned>>& unplanned, const TautPathBounds& bounds);

/// Returns the actions that execute the trajectory. They begin with the robot's committed actions, whose
/// moves the trajectory contains.
///
/// After the commitment, the robot rotates as soon as it arrives, and then waits. So it already has the next
/// heading while it waits before a translation. `zones` limit the speeds; null if there are none.
std::vector<Action> to_actions(const Robot& robot, const Trajectory& trajectory,
                               const DriveZones* zones = nullptr);

}  // namespace fleetplan::core
