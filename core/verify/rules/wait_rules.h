#pragma once

#include "core/model/plan.h"
#include "core/model/robot.h"
#include "core/runtime/stop_condition.h"
#include "core/verify/tolerances.h"
#include "core/verify/violation_list.h"

namespace fleetplan::core {

/// Reports translations (`speed`) before which the robot, already turned, stands still for less than `wait`
/// seconds. Translations that follow each other in one straight line are one; committed ones are not judged.
/// A robot that is committed to stand still at t = 0 may have done so for any time before.
ViolationList check_waits(const Robot& robot, const RobotPlan& plan, double wait, const Tolerance& tolerance,
                          const StopCondition& stop);

}  // namespace fleetplan::core
