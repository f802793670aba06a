#pragma once

// The motion of a point relative to another one, both straight at constant speed.

#include <optional>

#include "core/geometry/position.h"

namespace fleetplan::core {

/// The displacement from one point to another, linear in time. If neither moves, or both have the same
/// velocity, from == to, and t_end may be infinite.
struct RelativeMotion {
  double t_begin = 0.0;
  double t_end = 0.0;
  Position from{0.0, 0.0};
  Position to{0.0, 0.0};
};

/// The time and distance of the closest approach; the first such time if there are several.
struct ClosestMoment {
  double t = 0.0;
  double distance = 0.0;  // metres
};

struct TimeSpan {
  double begin = 0.0;
  double end = 0.0;
};

/// The least squared distance, m^2. The error of the distance is a few ulp of the larger coordinate.
double least_squared_distance(const RelativeMotion& motion);

/// The moment of least distance, as exact as `least_squared_distance`. Where the points come nearer by at
/// most kSamePosition, which may be rounding, it is the beginning.
ClosestMoment closest_moment(const RelativeMotion& motion);

/// The open time span in which the distance is less than `distance`; none if it never is. If the span begins
/// or ends inside the motion, its error is a few ulp of the coordinates divided by the speed, or the square
/// root of that where the approach is tangential; at an end of the motion it is exact.
std::optional<TimeSpan> span_closer_than(const RelativeMotion& motion, double distance);

}  // namespace fleetplan::core
