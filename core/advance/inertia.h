#pragma once

// How robots brake that need time to stop, and start again.

#include <cstddef>
#include <vector>

#include "core/model/action.h"

namespace fleetplan::core {

/// Returns what has been executed at `t`, on the clock of the actions; an action under way is cut there.
std::vector<Action> executed_until(const std::vector<Action>& actions, double t);

/// Returns the actions of a robot that stands from `t` on: one under way is cut there. A robot that needs
/// time to stop brakes before `t`; one that cannot any more brakes from the first action on, and stands
/// later. A rotation with a profile that is under way at t = 0 is whole, and a later one is left out.
std::vector<Action> stopped_by(const std::vector<Action>& actions, double t);

/// Returns the actions of a robot that begins to brake at `t`. Actions that it has not begun then are left
/// out.
std::vector<Action> braked(const std::vector<Action>& actions, double t);

/// Goes on after the first actions, which stopped_by() has left of all of them, to the end of these; later if
/// the robot has to start again.
std::vector<Action> resumed_after(const std::vector<Action>& stopped, const std::vector<Action>& actions);

/// Return the parts of an action before and after a time within it. A part with a profile begins, or ends, at
/// the speed that the robot has then.
Action part_until(Action action, double t);
Action part_from(Action action, double t);

/// Returns what is left of an action at a time within it: metres, radians, or seconds of a wait.
double left_of(const Action& action, double t);

/// Returns the actions, the last of which come to rest: as fast as they can, if they end at a speed.
std::vector<Action> at_rest_in_the_end(std::vector<Action> actions);

/// Returns one past the last of the actions from an index on that follow each other at speed.
std::size_t end_of_chain(const std::vector<Action>& actions, std::size_t first);

/// Drives actions that follow each other at speed, from `t` and a speed on, as fast as their cruise speeds
/// allow, to rest. A speed from which the robot could not stop in time is taken for the greatest from which
/// it can.
std::vector<Action> driven_from(std::vector<Action> chain, double t, double speed);

}  // namespace fleetplan::core
