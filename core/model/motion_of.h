#pragma once

#include "core/model/plan_options.h"
#include "core/model/robot.h"
#include "core/motion.h"

namespace fleetplan::core {

/// How the robot moves under these options.
inline Motion motion_of(const Robot& robot, const PlanOptions& options) {
  return {robot.radius + options.inflation,
          robot.linear_speed,
          robot.angular_speed,
          options.wait_before_move,
          robot.radius + options.inflation + robot.vicinity,
          robot.may_reverse};
}

}  // namespace fleetplan::core
