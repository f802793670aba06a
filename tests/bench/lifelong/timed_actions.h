#pragma once

#include <vector>

#include "core/model/action.h"

namespace fleetplan::bench {

/// What a robot executes: contiguous actions in time and space.
using Actions = std::vector<core::Action>;

/// Where a robot is at `t` that executes `actions`; before and after them at their ends. `rest`: where it is
/// if there are none.
core::Pose pose_at(const Actions& actions, double t, const core::Pose& rest);

/// The actions before and after a time. An action under way at this time is cut.
struct CutActions {
  Actions before;
  Actions after;
};
CutActions cut(const Actions& actions, double t);

/// The same actions `seconds` later.
Actions shifted(Actions actions, double seconds);

/// Ends with a wait until `t` if they end earlier. `rest`: where the robot is if there are no actions, from
/// `begin` on.
Actions waiting_until(Actions actions, double t, double begin, const core::Pose& rest);

/// All that comes after `t` takes place `seconds` later; the robot waits meanwhile.
Actions paused(const Actions& actions, double t, double seconds);

/// Seconds of rotations and translations between two times.
double moving_time(const Actions& actions, double from, double to);

/// Whether two robots in the same place move in the same way at the same times. Waits, and actions that are
/// cut in two, do not count.
bool same_motion(const Actions& a, const Actions& b);

}  // namespace fleetplan::bench
