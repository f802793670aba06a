#pragma once

#include "core/model/plan_options.h"
#include "core/model/robot.h"
#include "core/motion.h"

namespace fleetplan::core {

/// How the robot moves under these options while it has this radius (metres).
inline Motion motion_of(const Robot& robot, const PlanOptions& options, double radius) {
  return {radius + options.inflation,
          robot.linear_speed,
          robot.angular_speed,
          options.wait_before_move,
          radius + options.inflation + robot.vicinity,
          robot.may_reverse};
}
inline Motion motion_of(const Robot& robot, const PlanOptions& options) {
  return motion_of(robot, options, robot.radius);
}

}  // namespace fleetplan::core
