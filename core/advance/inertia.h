#pragma once

// How robots that need time to stop brake and start again.

#include <cstddef>
#include <vector>

#include "core/model/action.h"

namespace fleetplan::core {

/// Returns what has been executed at `t`, on the clock of the actions. An action under way is cut there.
std::vector<Action> executed_until(const std::vector<Action>& actions, double t);

/// Returns the actions of a robot that stands from `t` on; an action under way is cut there.
///
/// - A robot that needs time to stop brakes before `t`.
/// - A robot that can no longer stop by `t` brakes from the first action on, and stands later.
/// - A rotation with a profile that is under way at t = 0 is kept whole. A later rotation is left out.
std::vector<Action> stopped_by(const std::vector<Action>& actions, double t);

/// Returns the actions of a robot that begins to brake at `t`. Actions that it has not begun by then are left
/// out.
std::vector<Action> braked(const std::vector<Action>& actions, double t);

/// Continues after `stopped`, the first actions, which stopped_by() has kept of all actions, to their end.
/// The end is later if the robot has to start again.
std::vector<Action> resumed_after(const std::vector<Action>& stopped, const std::vector<Action>& actions);

/// Return the parts of an action before and after a time within it. A part of an action with a profile
/// begins, or ends, at the robot's speed at this time.
Action part_until(Action action, double t);
Action part_from(Action action, double t);

/// Returns how much of an action is left at a time within it: metres, radians, or seconds of a wait.
double left_of(const Action& action, double t);

/// Returns the actions such that the robot rests at the end. If the last actions end at a speed, they come to
/// rest as fast as they can.
std::vector<Action> at_rest_in_the_end(std::vector<Action> actions);

/// Returns one past the last action of a chain: the actions from this index on that follow each other at
/// speed.
std::size_t end_of_chain(const std::vector<Action>& actions, std::size_t first);

/// Drives actions that follow each other at speed, from `t` and a speed on, as fast as their cruise speeds
/// allow, to rest. If the robot could not stop in time from the speed, the greatest speed from which it can
/// is used instead.
std::vector<Action> driven_from(std::vector<Action> chain, double t, double speed);

}  // namespace fleetplan::core
