#pragma once

// What a robot executes, seen from a moment during its execution.

#include <cstddef>
#include <optional>
#include <vector>

#include "core/advance/moment.h"
#include "core/execution/dependencies.h"
#include "core/model/action.h"
#include "core/model/robot.h"

namespace fleetplan::core {

/// How far a robot is in its actions.
struct TimedProgress {
  std::size_t action = 0;  // under way; the number of all actions if they are done
  double t = 0.0;          // the planned time of this progress, seconds
};

/// The rest of a robot's actions on a clock that is 0 at the moment: contiguous from `start` and t = 0.
struct Remainder {
  Pose start;
  std::vector<Action> actions;
};

/// Returns the progress at this time by the plan.
TimedProgress planned_progress(const std::vector<Action>& actions, double at);

/// Returns the pose at this time by the plan.
Pose planned_pose(const Robot& robot, const std::vector<Action>& actions, double at);

/// Returns the progress that fits a measured pose. It is in the latest action that the plan has begun by this
/// time, and whose path is near the pose. Near is within the tolerance (metres, and radians of the heading).
/// So a robot may be late, or early within the action under way. None if there is no such action.
std::optional<TimedProgress> measured_progress(const Robot& robot, const std::vector<Action>& actions,
                                               const Pose& pose, double at, double tolerance);

/// Returns the progress that is reported. A service that is not finished counts as beginning: its goal keeps
/// what is left.
TimedProgress reported_progress(const std::vector<Action>& actions, const ReportedState& reported);

/// Returns the planned pose at the reported progress.
Pose pose_of(const std::vector<Action>& actions, const ReportedState& reported);

/// Whether two poses are within this tolerance of each other: metres, and radians of heading.
bool is_near(const Pose& pose, const Pose& other, double tolerance);

/// Returns the actions from this time on.
Remainder remainder(const Robot& robot, const std::vector<Action>& actions, double at);

/// Returns the remainder of a robot that was measured. It continues a translation straight from the pose to
/// its end, and a rotation from its heading, at the planned speed.
///
/// The other actions shift by the delay of this end. If it ends earlier, the robot waits. A robot that stands
/// is where its plan has it. `speed`: the measured speed, metres per second. A robot with a profile goes on
/// from this speed, by default from the planned speed.
Remainder remainder_of_measured(const Robot& robot, const std::vector<Action>& actions, const Pose& pose,
                                const TimedProgress& progress, double at, std::optional<double> speed = {});

/// Returns the remainder of a robot that has reported its progress. It goes on in the same way from the
/// measured pose, or from the planned pose at this progress. A wait continues for what is left of it. In a
/// wait for a goal, what is left of the service, as planned or reported, begins at the goal's `not_before` at
/// the earliest.
Remainder remainder_of_reported(const Robot& robot, const Execution& execution, const TimedProgress& progress,
                                double at);

/// Returns the first action, and the actions that follow it in one line without a stop, until the robot has
/// driven so many metres. Empty if the first action is no translation.
std::vector<Action> driven_until(const std::vector<Action>& actions, double metres);

/// Whether a translation goes on with the next one without a stop.
bool goes_on(const Action& action, const Action& next);

/// Appends actions at their planned times. If the actions before end later, these and all that follow are
/// later. If they end earlier, the robot waits first. Actions of an invalid plan may overlap in time.
void append(std::vector<Action>& actions, const std::vector<Action>& following);

/// Returns all actions, but divides an action under way at `t` in two: the robot stands at `t`, see
/// stopped_by().
std::vector<Action> split_at(const std::vector<Action>& actions, double t);

/// Inserts a wait from `from`, when the robot stands, until `until`, and delays the actions after it. A wait
/// under way is not delayed. A service under way goes on, and stays a service.
void hold(Remainder& rest, double from, double until);

/// Returns the pose in an action at a time within it.
Pose pose_at(const Action& action, double t);

}  // namespace fleetplan::core
