#pragma once

#include <cstddef>
#include <optional>

#include "core/model/plan.h"
#include "core/model/robot.h"
#include "core/verify/tolerances.h"
#include "core/verify/verify.h"
#include "core/verify/violation_list.h"

namespace fleetplan::core {

/// Reports a number of the robot, its commitment or its plan (null: none) that is infinite, not a number, or
/// larger than 1e30, as a discontinuity. No other check is possible for such a robot.
std::optional<Violation> find_unusable_number(std::size_t index, const Robot& robot, const RobotPlan* plan);

/// Checks that actions are contiguous in time and space, correspond to their types and end at the cost
/// (`discontinuity`), and that the robot keeps to its speeds and moves along its heading (`speed`). All
/// numbers are usable. The first `given` actions are not judged. Ends early when `stop` is met.
ViolationList check_motion(const Robot& robot, const RobotPlan& plan, std::size_t given,
                           const Tolerance& tolerance, const StopCondition& stop);

}  // namespace fleetplan::core
