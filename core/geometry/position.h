#pragma once

// Where things are. Everything in core/ lives in the map frame: metres, origin in the lower-left corner of
// the map, x right, y up. The API adds and removes the map's world origin, so that planning keeps its
// precision even where world coordinates are large (UTM).

#include <Eigen/Core>

namespace fleetplan::core {

/// A point or a displacement in the plane, metres.
using Position = Eigen::Vector2d;

/// Position and heading; theta in radians, counter-clockwise from +x (REP-103), normalised to (-pi, pi].
struct Pose {
  Position position{0.0, 0.0};
  double theta = 0.0;
};

}  // namespace fleetplan::core
