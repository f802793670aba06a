#pragma once

#include <algorithm>

#include "core/geometry/position.h"
#include "core/geometry/speed_profile.h"
#include "core/geometry/tolerance.h"
#include "core/model/loads.h"
#include "core/model/plan_options.h"
#include "core/model/robot.h"

namespace fleetplan::core {

/// How one robot moves, with the plan's options applied.
struct Motion {
  double wall_radius = 0.0;       // metres, to walls: the bare radius (Load::radius) and the inflation
  double linear_speed = 0.0;      // metres per second
  double angular_speed = 0.0;     // radians per second
  double wait_before_move = 0.0;  // seconds
  double pair_radius = 0.0;       // metres, to other robots: with the vicinity, too
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

/// Returns how the robot moves under these options while it carries this load.
inline Motion motion_of(const Robot& robot, const PlanOptions& options, const Load& load) {
  return {load.radius + options.inflation,
          load.linear_speed,
          robot.angular_speed,
          options.wait_before_move > 0.0 ? std::max(options.wait_before_move, kShortestWait) : 0.0,
          load.radius + options.inflation + robot.vicinity,
          robot.may_reverse,
          load.linear_inertia(),
          robot.angular_inertia()};
}

}  // namespace fleetplan::core
