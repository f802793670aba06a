#pragma once

#include <cstddef>

namespace fleetplan::core {

/// A visit of a robot to one of its goals. Seconds.
struct Visit {
  std::size_t goal = 0;   // see Robot::goal_at
  double t_arrive = 0.0;  // from then on at rest in the goal pose
  double t_leave = 0.0;   // the end of the service; kForever at the last goal, where the robot stays
};

}  // namespace fleetplan::core
