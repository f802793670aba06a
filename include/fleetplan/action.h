#pragma once

#include <fleetplan/pose.h>

#include <cstddef>
#include <limits>
#include <optional>
#include <span>

namespace fleetplan {

/// The speed of a translation (metres per second) or a rotation (radians per second) over time. It rises from
/// `start` to `cruise` at constant acceleration, stays at `cruise`, and falls to `end` at constant
/// deceleration.
struct Profile {
  double start = 0.0;   // >= 0, at t_start; positive backwards, too
  double cruise = 0.0;  // > 0, not less than start and end
  double end = 0.0;     // >= 0, at t_end
  /// The robot's acceleration and deceleration, per second squared. Infinite: the speed changes at once.
  /// Committed and previous actions may leave them out.
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
  /// The goal that is served during this wait, or whose `not_before` the robot waits for. None for other
  /// waits and actions.
  std::optional<std::size_t> goal;
  /// Whether the robot translates backwards: the heading is opposite to the direction of motion.
  bool reverse = false;
  /// How the speed changes, if the robot's acceleration is limited. None: constant speed, as in measured
  /// motion.
  std::optional<Profile> profile = {};
};

/// Returns the pose at time `t` (seconds) of a robot that begins in `start` and executes contiguous actions.
/// Before the first action, this is `start`; after the last one, its end. The time grows with the logarithm
/// of the number of actions.
Pose pose_at(std::span<const Action> actions, const Pose& start, double t);

}  // namespace fleetplan
