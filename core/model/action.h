#pragma once

#include <cstddef>
#include <optional>

#include "core/geometry/position.h"

namespace fleetplan::core {

/// One rotation, translation or wait of a robot, from one pose to another, at constant speed. Times in
/// seconds from the start of the plan.
struct Action {
  enum class Type { rotate, translate, wait };
  Type type = Type::wait;
  double t_start = 0.0;
  double t_end = 0.0;
  Pose from;
  Pose to;
  /// Of a wait: the goal of the robot (see Robot::goal_at) that is served during it, or whose `not_before` is
  /// awaited.
  std::optional<std::size_t> goal = {};
  /// Of a translation: backwards; the heading is opposite to the direction of motion.
  bool reverse = false;
};

}  // namespace fleetplan::core
