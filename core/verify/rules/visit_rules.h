#pragma once

// Where a plan has to begin, to call and to end.

#include <cstddef>
#include <vector>

#include "core/model/plan.h"
#include "core/model/robot.h"
#include "core/runtime/stop_condition.h"
#include "core/verify/check_rules.h"
#include "core/verify/violations.h"

namespace fleetplan::core {

/// Checks that a plan begins at the robot's start (`wrong_start`) and rests at its goal (`wrong_goal`).
/// Reports each at most once: the position if that is wrong, otherwise the heading. A parked robot must rest
/// at its start, in any heading. With goals left, a plan may rest anywhere.
std::vector<Violation> check_endpoints(const Robot& robot, const RobotPlan& plan, const Tolerance& tolerance,
                                       GoalsLeft goals_left);

/// Checks that the robot visits its goals (`wrong_visit`): in their order it rests in the pose of each, from
/// `not_before` on, for the whole service, the last one at the end of its plan. Rests are uninterrupted
/// waits, the instants between two actions included. Reports the first goal that is not visited, and each
/// visit, or `goal` of a wait that is not committed, that does not take place. Whether the robot ends at its
/// last goal is not part of this (see check_endpoints). With goals left, a plan may end before all are
/// visited.
std::vector<Violation> check_visits(const Robot& robot, const RobotPlan& plan, const Tolerance& tolerance,
                                    GoalsLeft goals_left, const StopCondition& stop);

/// Returns the number of goals before the last one that a robot serves if it executes nothing but its
/// commitment.
std::size_t goals_served_by_commitment(const Robot& robot, const Tolerance& tolerance,
                                       const StopCondition& stop);

}  // namespace fleetplan::core
