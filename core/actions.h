#pragma once

#include <vector>

#include "core/model/plan.h"
#include "core/model/robot.h"
#include "core/model/trajectory.h"

namespace fleetplan::core {

/// The trajectory as the actions that the robot executes. It rotates as soon as it has arrived and waits
/// afterwards, so that a wait before a translation is spent already turned.
std::vector<Action> to_actions(const Robot& robot, const Trajectory& trajectory);

}  // namespace fleetplan::core
