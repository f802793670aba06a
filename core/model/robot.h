#pragma once

#include <optional>
#include <string>

#include "core/geometry/position.h"

namespace fleetplan::core {

/// The pose in which a robot comes to rest; without theta, its heading there is free.
struct Goal {
  Position position{0.0, 0.0};
  std::optional<double> theta;  // radians, (-pi, pi]
};

/// A differential-drive robot: an open disk that waits, rotates in place or translates straight ahead,
/// without inertia (paper, Problem Statement).
struct Robot {
  std::string id;
  double radius = 0.0;         // metres, > 0
  double linear_speed = 0.0;   // metres per second, > 0
  double angular_speed = 0.0;  // radians per second, > 0
  Pose start;
  std::optional<Goal> goal;  // nullopt: parked, it stays at its start
};

}  // namespace fleetplan::core
