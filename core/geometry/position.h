#pragma once

// Positions and poses in the map frame, which all of core/ uses: metres, origin in the lower-left corner of
// the map, x right, y up. The API adds and subtracts the map's world origin, so that planning stays precise
// even if world coordinates are large (UTM).

#include <Eigen/Core>

#include "core/geometry/tolerance.h"

namespace fleetplan::core {

/// A point or a displacement in the plane, metres.
using Position = Eigen::Vector2d;

/// The product of the lengths and the sine of the angle from `a` to `b`; > 0 if `b` is to the left.
inline double cross_product(const Position& a, const Position& b) { return a.x() * b.y() - a.y() * b.x(); }

/// Position and heading; theta in radians, counter-clockwise from +x (REP-103), normalised to (-pi, pi].
struct Pose {
  Position position{0.0, 0.0};
  double theta = 0.0;
};

/// Whether the two are the same up to rounding, see kSamePosition.
inline bool is_same_position(const Position& a, const Position& b) {
  return (a - b).squaredNorm() <= kSamePosition * kSamePosition;
}

}  // namespace fleetplan::core
