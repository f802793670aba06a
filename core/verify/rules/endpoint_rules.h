#pragma once

#include <vector>

#include "core/model/plan.h"
#include "core/model/robot.h"
#include "core/verify/tolerances.h"
#include "core/verify/verify.h"

namespace fleetplan::core {

/// Checks that a plan begins at the robot's start (`wrong_start`) and rests at its goal (`wrong_goal`).
/// Reports each at most once: the position if that is wrong, otherwise the heading. A parked robot must rest
/// at its start, in any heading. With goals left, a plan may rest anywhere.
std::vector<Violation> check_endpoints(const Robot& robot, const RobotPlan& plan, const Tolerance& tolerance,
                                       GoalsLeft goals_left);

}  // namespace fleetplan::core
