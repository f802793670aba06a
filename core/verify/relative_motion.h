#pragma once

// Two points that both move straight at constant speed, seen from one of them.

#include <optional>

#include "core/geometry/position.h"

namespace fleetplan::core {

/// The displacement from one point to another, linear in time. from == to where neither moves, or both alike;
/// t_end may then be infinite.
struct RelativeMotion {
  double t_begin = 0.0;
  double t_end = 0.0;
  Position from{0.0, 0.0};
  Position to{0.0, 0.0};
};

/// When and how near, the first such moment if there are several.
struct ClosestMoment {
  double t = 0.0;
  double distance = 0.0;  // metres
};

struct TimeSpan {
  double begin = 0.0;
  double end = 0.0;
};

/// The least squared distance, m^2. The distance is off by no more than a few ulp of the larger coordinate.
double least_squared_distance(const RelativeMotion& motion);

/// The moment of least distance, as exact as `least_squared_distance`; its time is that of the beginning
/// where the points come nearer by no more than kContactTolerance, as rounding alone makes them.
ClosestMoment closest_moment(const RelativeMotion& motion);

/// The open span in which the distance is less than `distance` (none where it never is). A span that begins
/// or ends inside the motion is off by a few ulp of the coordinates over the speed, and by the square root of
/// that where the approach is tangential; one that covers an end of the motion begins or ends exactly there.
std::optional<TimeSpan> span_closer_than(const RelativeMotion& motion, double distance);

}  // namespace fleetplan::core
