#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "core/geometry/position.h"
#include "core/geometry/speed_profile.h"
#include "core/geometry/tolerance.h"
#include "core/model/loads.h"
#include "core/model/plan_options.h"
#include "core/model/robot.h"

namespace fleetplan::core {

/// How large and how fast a robot is with one of its loads, with the plan's options applied.
struct Body {
  double radius = 0.0;            // metres, of the bare disk
  double wall_radius = 0.0;       // metres, to walls: with the inflation
  double pair_radius = 0.0;       // metres, to other robots: with the vicinity, too
  double linear_speed = 0.0;      // metres per second
  double angular_speed = 0.0;     // radians per second
  double wait_before_move = 0.0;  // seconds
  bool may_reverse = false;       // translate backwards, too

  Inertia linear_inertia = {};   // of translations
  Inertia angular_inertia = {};  // of rotations

  /// Seconds of a translation from rest to rest.
  double translation_time(double distance) const { return linear_inertia.time(distance, linear_speed); }
  /// Seconds at full speed.
  double cruise_time(double distance) const { return distance / linear_speed; }
  /// Seconds to turn from one normalised heading to another, the shorter way.
  double rotation_time(double from, double to) const {
    return angular_inertia.time(angle_between(from, to), angular_speed);
  }
};

/// Returns the body of the robot with this load under these options.
inline Body body_of(const Robot& robot, const PlanOptions& options, const Load& load) {
  return {.radius = load.radius,
          .wall_radius = load.radius + options.inflation,
          .pair_radius = load.radius + options.inflation + robot.vicinity,
          .linear_speed = load.linear_speed,
          .angular_speed = robot.angular_speed,
          .wait_before_move =
              options.wait_before_move > 0.0 ? std::max(options.wait_before_move, kShortestWait) : 0.0,
          .may_reverse = robot.may_reverse,
          .linear_inertia = load.linear_inertia(),
          .angular_inertia = robot.angular_inertia()};
}

/// Returns the robot's bodies in the stages that begin after so many goals are served.
inline std::vector<Body> bodies_of(const Robot& robot, const PlanOptions& options, std::size_t served) {
  const std::vector<Load> loads = loads_of(robot);
  std::vector<Body> bodies;
  for (std::size_t k = served; k < loads.size(); ++k) bodies.push_back(body_of(robot, options, loads[k]));
  return bodies;
}

}  // namespace fleetplan::core
