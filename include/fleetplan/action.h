#pragma once

#include <fleetplan/pose.h>

#include <cstddef>
#include <optional>
#include <span>

namespace fleetplan {

/// One rotation, translation or wait of a robot, from one pose to another, at constant speed.
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
  /// Of a wait: the goal of the robot that is served during it, or whose `not_before` is awaited.
  std::optional<std::size_t> goal;
  /// Of a translation: backwards, the heading is opposite to the direction of motion.
  bool reverse = false;
};

/// Where a robot is at time `t`, seconds, that begins in `start` and executes contiguous actions: in `start`
/// before the first one, and where the last one ends after it. The time grows with the logarithm of their
/// number.
Pose pose_at(std::span<const Action> actions, const Pose& start, double t);

}  // namespace fleetplan
