#pragma once

// What the plan of one robot does: how it moves (motion_rules.cpp): from action to action, within the speeds,
// after waits, and as committed; and where it begins, calls and ends (visit_rules.cpp).

#include <cstddef>
#include <optional>
#include <vector>

#include "core/model/plan.h"
#include "core/model/robot.h"
#include "core/runtime/stop_condition.h"
#include "core/verify/check_rules.h"
#include "core/verify/execution.h"
#include "core/verify/violations.h"

namespace fleetplan::core {

/// Reports a number of the robot, its commitment or its plan (null: none) that is infinite, not a number, or
/// larger than 1e30, as a discontinuity. No other check is possible for such a robot.
std::optional<Violation> find_unusable_number(std::size_t index, const Robot& robot, const RobotPlan* plan);

/// Checks that actions are contiguous in time and space, correspond to their types and end at the cost
/// (`discontinuity`), and that the robot keeps to its speeds and moves along its heading (`speed`). All
/// numbers are usable. The first `given` actions are not judged. Ends early when `stop` is met.
ViolationList check_motion(const Robot& robot, const RobotPlan& plan, std::size_t given,
                           const CarriedLoads& loads, const Tolerance& tolerance, const StopCondition& stop);

/// Reports translations (`speed`) before which the robot, already turned, stands still for less than `wait`
/// seconds. Translations that follow each other in one straight line are one; committed ones are not judged.
/// A robot that is committed to stand still at t = 0 may have done so for any time before.
ViolationList check_waits(const Robot& robot, const RobotPlan& plan, double wait, const Tolerance& tolerance,
                          const StopCondition& stop);

/// Reports a plan that does not begin with the committed actions (`committed_changed`), once: the first
/// number that differs, at all if `exact`, otherwise by more than the tolerance.
std::optional<Violation> check_commitments(const Robot& robot, const RobotPlan& plan,
                                           const Tolerance& tolerance, bool exact);

/// Checks that a plan begins at the robot's start (`wrong_start`) and rests at its goal (`wrong_goal`).
/// Reports each at most once: the position if that is wrong, otherwise the heading. A parked robot must rest
/// at its start, in any heading. With goals left, or of a robot that yields, a plan may rest anywhere.
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
