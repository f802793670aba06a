#pragma once

#include <fleetplan/pose.h>

#include <cstddef>
#include <limits>
#include <optional>
#include <span>

namespace fleetplan {

/// How the speed of a translation (metres per second) or a rotation (radians per second) changes: it rises at
/// constant acceleration from `start` to `cruise`, stays, and falls at constant deceleration to `end`.
struct Profile {
  double start = 0.0;   // >= 0, at t_start; positive backwards, too
  double cruise = 0.0;  // > 0, not less than start and end
  double end = 0.0;     // >= 0, at t_end
  /// Per second squared: those of the robot. Infinite: at once. Of committed and previous actions, they need
  /// not be given.
  double acceleration = std::numeric_limits<double>::infinity();
  double deceleration = std::numeric_limits<double>::infinity();
};

/// One rotation, translation or wait of a robot, from one pose to another, at constant speed or with a
/// profile.
struct Action {
  enum class Type {
    rotate,     // in place, the shorter way; exactly half a turn is counter-clockwise
    translate,  // straight ahead, or backwards with `reverse`; the heading stays
    wait,
  };
  Type type = Type::wait;
  double t_start = 0.0;  // seconds from the start of the plan
  double t_end = 0.0;    // seconds, >= t_start
  Pose from;
  Pose to;
  /// The goal of the robot that is served during this wait, or whose `not_before` is awaited; none for other
  /// waits and actions.
  std::optional<std::size_t> goal;
  /// Whether the robot translates backwards: the heading is opposite to the direction of motion.
  bool reverse = false;
  /// The speed of a robot whose acceleration is limited; none: constant, as measured motion is.
  std::optional<Profile> profile = {};
};

/// Returns the pose at time `t` (seconds) of a robot that begins in `start` and executes contiguous actions:
/// `start` before the first action, and the end of the last one after it. The time grows with the logarithm
/// of the number of actions.
Pose pose_at(std::span<const Action> actions, const Pose& start, double t);

}  // namespace fleetplan
