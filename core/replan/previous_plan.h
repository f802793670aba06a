#pragma once

#include <cstddef>
#include <vector>

#include "core/model/action.h"
#include "core/model/plan.h"
#include "core/model/robot.h"
#include "core/model/trajectory.h"

namespace fleetplan::core {

/// Whether any robot has a previous plan.
bool have_previous_plans(const std::vector<Robot>& robots);

/// The actions of the robot's previous plan as received. Without one, if it is empty or if the robot is
/// parked, the robot rests after its committed actions.
const std::vector<Action>& previous_actions(const Robot& robot);

/// These actions as a plan without visits, with 0 as lower bound.
RobotPlan previous_plan(std::size_t index, const Robot& robot);

/// The motion of a previous plan that holds (see KeptPlans).
Trajectory previous_trajectory(const Robot& robot);

}  // namespace fleetplan::core
