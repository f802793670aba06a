#pragma once

#include <cmath>
#include <numbers>

namespace fleetplan::core {

/// Returns the equivalent heading in (-pi, pi]. Any finite angle is accepted.
inline double normalize_angle(double angle) {
  constexpr double kPi = std::numbers::pi;
  if (angle > -kPi && angle <= kPi) return angle;
  const double wrapped = std::remainder(angle, 2.0 * kPi);  // in [-pi, pi]
  return wrapped <= -kPi ? kPi : wrapped;
}

/// The signed rotation in (-pi, pi] that turns heading `from` into heading `to` the shorter way; exactly half
/// a turn is counter-clockwise.
inline double rotation_between(double from, double to) { return normalize_angle(to - from); }

/// The absolute difference of two normalised headings, in [0, pi].
inline double angle_between(double a, double b) {
  const double d = std::abs(a - b);
  return d <= std::numbers::pi ? d : 2.0 * std::numbers::pi - d;
}

/// The heading of the other end of a robot with a normalised heading; normalised.
inline double opposite_heading(double heading) {
  return heading > 0.0 ? heading - std::numbers::pi : heading + std::numbers::pi;
}

}  // namespace fleetplan::core
