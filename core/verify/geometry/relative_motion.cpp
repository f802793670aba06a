#include "core/verify/geometry/relative_motion.h"

#include <algorithm>
#include <cmath>

#include "core/geometry/tolerance.h"

namespace fleetplan::core {
namespace {

double cross(const Position& a, const Position& b) { return a.x() * b.y() - a.y() * b.x(); }

/// The fraction of the motion, 0 to 1, at which the distance is least.
double closest_fraction(const RelativeMotion& motion) {
  const Position d = motion.to - motion.from;
  const double length_squared = d.squaredNorm();
  if (length_squared <= 0.0) return 0.0;
  return std::clamp(-motion.from.dot(d) / length_squared, 0.0, 1.0);
}

double time_at(const RelativeMotion& motion, double fraction) {
  if (fraction <= 0.0) return motion.t_begin;
  if (fraction >= 1.0) return motion.t_end;
  return motion.t_begin + fraction * (motion.t_end - motion.t_begin);
}

}  // namespace

double least_squared_distance(const RelativeMotion& motion) {
  const Position d = motion.to - motion.from;
  const double length_squared = d.squaredNorm();
  if (length_squared <= 0.0) return motion.from.squaredNorm();
  const double progress = -motion.from.dot(d);
  if (progress <= 0.0) return motion.from.squaredNorm();
  if (progress >= length_squared) return motion.to.squaredNorm();
  // The distance to the line from the cross product: unlike |from|^2 - along^2 it has no cancellation.
  const double area = cross(motion.from, d);
  return std::min({area * area / length_squared, motion.from.squaredNorm(), motion.to.squaredNorm()});
}

ClosestMoment closest_moment(const RelativeMotion& motion) {
  const double distance = std::sqrt(least_squared_distance(motion));
  const bool from_the_beginning = motion.from.norm() <= distance + kSamePosition;
  return {from_the_beginning ? motion.t_begin : time_at(motion, closest_fraction(motion)), distance};
}

std::optional<TimeSpan> span_closer_than(const RelativeMotion& motion, double distance) {
  if (distance <= 0.0) return std::nullopt;
  const double squared = distance * distance;
  const bool begins_inside = motion.from.squaredNorm() < squared;
  const bool ends_inside = motion.to.squaredNorm() < squared;
  // The distance is convex in time, so if both ends are inside, all of the motion is.
  if (begins_inside && ends_inside) return TimeSpan{motion.t_begin, motion.t_end};
  const double least = least_squared_distance(motion);
  if (least >= squared) return std::nullopt;

  const Position d = motion.to - motion.from;
  const double length_squared = d.squaredNorm();  // > 0, as one end is inside or the middle is nearer
  const double area = cross(motion.from, d);
  const double middle = -motion.from.dot(d) / length_squared;
  const double half = std::sqrt(std::max(0.0, squared - area * area / length_squared) / length_squared);
  const double first = begins_inside ? 0.0 : std::clamp(middle - half, 0.0, 1.0);
  const double last = ends_inside ? 1.0 : std::clamp(middle + half, 0.0, 1.0);
  return TimeSpan{time_at(motion, first), time_at(motion, last)};
}

}  // namespace fleetplan::core
