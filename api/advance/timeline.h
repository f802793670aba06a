#pragma once

// What a robot executes, seen from a later moment.

#include <cstddef>
#include <optional>
#include <vector>

#include "core/model/action.h"
#include "core/model/robot.h"

namespace fleetplan::api {

/// Where a robot is in its actions.
struct Progress {
  std::size_t action = 0;  // under way; the number of all actions if they are done
  double t = 0.0;          // the planned time of this progress, seconds
};

/// The rest of a robot's actions on a clock that is 0 at the moment: contiguous from `start` and t = 0.
struct Remainder {
  core::Pose start;
  std::vector<core::Action> actions;
};

/// As planned, at this time.
Progress planned_progress(const std::vector<core::Action>& actions, double at);

/// By a measured pose: the latest action, not later than the one planned at this time, whose path is no
/// further from the pose than the tolerance (metres; the heading likewise, radians). A robot may be late, or
/// early in the action under way. Nothing if there is none.
std::optional<Progress> measured_progress(const core::Robot& robot, const std::vector<core::Action>& actions,
                                          const core::Pose& pose, double at, double tolerance);

/// The actions from this time on.
Remainder remainder(const core::Robot& robot, const std::vector<core::Action>& actions, double at);

/// The same for a robot that was measured. It continues a translation straight from the pose to its end, and
/// a rotation from its heading, at the planned speed. The other actions follow as much later as this ends
/// later; if it ends earlier, the robot waits. A robot that stands is where its plan has it.
Remainder remainder_of_measured(const core::Robot& robot, const std::vector<core::Action>& actions,
                                const core::Pose& pose, const Progress& progress, double at);

/// Puts a wait until this time before the rest of the actions, which it delays, except for the wait under
/// way.
void hold(Remainder& rest, double until);

/// The actions until `t`, on the clock of the actions; one under way is cut there.
std::vector<core::Action> actions_until(const std::vector<core::Action>& actions, double t);

/// The same with the actions after `t`: an action under way becomes two.
std::vector<core::Action> split_at(const std::vector<core::Action>& actions, double t);

/// The pose in an action at a time within it.
core::Pose pose_at(const core::Action& action, double t);

}  // namespace fleetplan::api
