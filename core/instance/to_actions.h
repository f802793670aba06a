#pragma once

#include <vector>

#include "core/model/drive_zones.h"
#include "core/model/plan.h"
#include "core/model/robot.h"
#include "core/model/trajectory.h"

namespace fleetplan::core {

/// The actions that execute the trajectory. They begin with the robot's committed actions, whose moves the
/// trajectory contains. After these the robot rotates as soon as it has arrived and then waits, so
/// that it already has the next heading while it waits before a translation. `zones` limit the speeds; null
/// if there are none.
std::vector<Action> to_actions(const Robot& robot, const Trajectory& trajectory,
                               const DriveZones* zones = nullptr);

}  // namespace fleetplan::core
