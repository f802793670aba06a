#include "core/verify/geometry/relative_motion.h"

#include <cmath>
#include <limits>

#include "core/geometry/tolerance.h"

namespace fleetplan::core {
namespace {

double cross(const Position& a, const Position& b) { return a.x() * b.y() - a.y() * b.x(); }

/// Returns the fraction of the motion, 0 to 1, at which the distance is least.
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

double least_distance(const std::vector<Leg>& a, const std::vector<Leg>& b, const TimeSpan& span) {
  double squared = std::numeric_limits<double>::infinity();
  visit_common_pieces(a, b, span, [&](const RelativeMotion& motion) {
    squared = std::min(squared, least_squared_distance(motion));
    return true;
  });
  return std::sqrt(squared);
}

std::optional<TimeSpan> time_together(const std::vector<Leg>& a, const std::vector<Leg>& b, double distance,
                                      double t) {
  std::optional<TimeSpan> together;
  const TimeSpan all_time{0.0, std::numeric_limits<double>::infinity()};
  visit_common_pieces(a, b, all_time, [&](const RelativeMotion& motion) {
    const auto near = span_closer_than(motion, distance);
    if (near) {
      if (together && together->end == near->begin) {
        together->end = near->end;
      } else if (together && together->end >= t) {
        return false;
      } else {
        together = near;
      }
    }
    return motion.t_begin <= t || (together && together->end == motion.t_end);
  });
  if (!together || together->begin > t || together->end < t) return std::nullopt;
  return together;
}

namespace {

/// A pair of times, and the displacement from one body to the other then. The displacement is affine in the
/// times, so pairs of times that form a convex polygon have displacements that form one, too.
struct Corner {
  double s;
  double t;
  Position apart{0.0, 0.0};
};

/// Returns the part of a convex polygon in which `sign * (s - t) <= margin`.
std::vector<Corner> clip(const std::vector<Corner>& polygon, double sign, double margin) {
  std::vector<Corner> kept;
  const auto beyond = [&](const Corner& corner) { return sign * (corner.s - corner.t) - margin; };
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Corner& here = polygon[k];
    const Corner& next = polygon[(k + 1) % polygon.size()];
    const double here_beyond = beyond(here);
    const double next_beyond = beyond(next);
    if (here_beyond <= 0.0) kept.push_back(here);
    if ((here_beyond < 0.0 && next_beyond > 0.0) || (here_beyond > 0.0 && next_beyond < 0.0)) {
      const double part = here_beyond / (here_beyond - next_beyond);
      kept.push_back({here.s + part * (next.s - here.s), here.t + part * (next.t - here.t)});
    }
  }
  return kept;
}

/// The area, as a share of the square of the coordinates, below which a polygon is a line, whose edges have
/// its distances. The turns of a line to or from the origin are rounding (1e-15) and say nothing.
constexpr double kLeastArea = 1e-12;

/// Whether the origin is inside the polygon of displacements.
bool surrounds_origin(const std::vector<Corner>& polygon) {
  bool left = false;
  bool right = false;
  double area = 0.0;
  double largest = 0.0;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Position& a = polygon[k].apart;
    const Position& b = polygon[(k + 1) % polygon.size()].apart;
    const double turn = a.x() * b.y() - a.y() * b.x();
    area += turn;
    largest = std::max(largest, a.squaredNorm());
    left = left || turn > 0.0;
    right = right || turn < 0.0;
  }
  return std::abs(area) > kLeastArea * largest && left != right;
}

}  // namespace

ShiftedMoment least_shifted_distance(const Leg& a, const TimeSpan& first, const Leg& b,
                                     const TimeSpan& second, double margin) {
  std::vector<Corner> polygon{{first.begin, second.begin},
                              {first.end, second.begin},
                              {first.end, second.end},
                              {first.begin, second.end}};
  polygon = clip(clip(polygon, 1.0, margin), -1.0, margin);
  ShiftedMoment nearest{std::numeric_limits<double>::infinity(), 0.0, 0.0};
  for (Corner& corner : polygon) corner.apart = position_at(b, corner.t) - position_at(a, corner.s);
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Corner& from = polygon[k];
    const Corner& to = polygon[(k + 1) % polygon.size()];
    // The edge is passed as a motion whose time is the fraction of the edge.
    const ClosestMoment closest = closest_moment({0.0, 1.0, from.apart, to.apart});
    if (closest.distance >= nearest.distance) continue;
    nearest = {closest.distance, from.s + closest.t * (to.s - from.s), from.t + closest.t * (to.t - from.t)};
  }
  if (surrounds_origin(polygon)) nearest.distance = 0.0;
  return nearest;
}

}  // namespace fleetplan::core
