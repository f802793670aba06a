#pragma once

#include <fleetplan/fleetplan.h>

#include <utility>
#include <vector>

namespace fleetplan {

/// A robot of radius 0.3 m, 1 m/s and 3 rad/s.
inline Robot robot_from(Pose start, std::vector<Goal> goals) {
  Robot robot;
  robot.radius = 0.3;
  robot.linear_speed = 1.0;
  robot.angular_speed = 3.0;
  robot.start = start;
  robot.goals = std::move(goals);
  return robot;
}

/// Two robots that swap the ends of a corridor with a passing bay; `origin` is its lower left corner.
inline Problem corridor_swap(Position origin = {}) {
  const double x = origin.x;
  const double y = origin.y;
  return {Map::from_rows({"####.####", "........."}, 1.0, origin),
          {robot_from({x + 0.5, y + 0.5, 0.0}, {{x + 8.5, y + 0.5}}),
           robot_from({x + 8.5, y + 0.5, 0.0}, {{x + 0.5, y + 0.5}})}};
}

}  // namespace fleetplan
