#pragma once

#include <optional>
#include <vector>

#include "core/model/plan.h"
#include "core/model/robot.h"
#include "core/verify/verify.h"

namespace fleetplan::core {

/// A number of the robot or its plan (null: none) with which nothing can be computed: infinite, not a number,
/// or larger than 1e30. Reported as a discontinuity; nothing else can be said about such a robot.
std::optional<Violation> find_unusable_number(std::size_t index, const Robot& robot, const RobotPlan* plan);

/// Whether actions follow each other in time and space, do what their type says, and add up to the cost
/// (`discontinuity`); and whether the robot can be that fast and moves along its heading (`speed`). Every
/// number is usable.
std::vector<Violation> check_motion(const Robot& robot, const RobotPlan& plan, double tolerance);

}  // namespace fleetplan::core
