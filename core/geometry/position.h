#pragma once

// Positions, headings and poses in the map frame, which all of core/ uses. Units are metres; the origin is
// the lower-left corner of the map, x right, y up. The API adds and subtracts the map's world origin, so
// planning stays precise even with large world coordinates (UTM).

#include <Eigen/Core>
#include <cmath>
#include <numbers>

#include "core/geometry/tolerance.h"

namespace fleetplan::core {

/// A point or a displacement in the plane, metres.
using Position = Eigen::Vector2d;

/// Returns the product of the lengths and the sine of the angle from `a` to `b`; > 0 if `b` is to the left.
inline double cross_product(const Position& a, const Position& b) { return a.x() * b.y() - a.y() * b.x(); }

/// Position and heading; theta in radians, counter-clockwise from +x (REP-103), normalised to (-pi, pi].
struct Pose {
  Position position{0.0, 0.0};
  double theta = 0.0;
};

/// Whether the two positions are the same up to rounding, see kSamePosition.
inline bool is_same_position(const Position& a, const Position& b) {
  return (a - b).squaredNorm() <= kSamePosition * kSamePosition;
}

/// Returns the equivalent heading in (-pi, pi]. Any finite angle is accepted.
inline double normalize_angle(double angle) {
  constexpr double kPi = std::numbers::pi;
  if (angle > -kPi && angle <= kPi) return angle;
  const double wrapped = std::remainder(angle, 2.0 * kPi);  // in [-pi, pi]
  return wrapped <= -kPi ? kPi : wrapped;
}

/// Returns the signed rotation in (-pi, pi] that turns heading `from` into heading `to` the shorter way.
/// Exactly half a turn is counter-clockwise.
inline double rotation_between(double from, double to) { return normalize_angle(to - from); }

/// Returns the absolute difference of two normalised headings, in [0, pi].
inline double angle_between(double a, double b) {
  const double d = std::abs(a - b);
  return d <= std::numbers::pi ? d : 2.0 * std::numbers::pi - d;
}

/// Returns the heading of the robot's other end, for a normalised heading; normalised.
inline double opposite_heading(double heading) {
  return heading > 0.0 ? heading - std::numbers::pi : heading + std::numbers::pi;
}

}  // namespace fleetplan::core
