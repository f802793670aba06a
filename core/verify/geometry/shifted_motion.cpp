#include "core/verify/geometry/shifted_motion.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace fleetplan::core {
namespace {

/// A pair of times, and the displacement from the one body to the other then. The displacement is affine in
/// the times, so pairs of times that form a convex polygon have displacements that do.
struct Corner {
  double s;
  double t;
  Position apart{0.0, 0.0};
};

/// Keeps what has `sign * (s - t) <= margin` of a convex polygon.
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

/// A polygon of less area, as a part of the square of the coordinates, is a line, whose edges have its
/// distances. The turns of a line to or from the origin are rounding (1e-15) and say nothing.
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
    // The time of this motion is the fraction of the edge.
    const ClosestMoment closest = closest_moment({0.0, 1.0, from.apart, to.apart});
    if (closest.distance >= nearest.distance) continue;
    nearest = {closest.distance, from.s + closest.t * (to.s - from.s), from.t + closest.t * (to.t - from.t)};
  }
  if (surrounds_origin(polygon)) nearest.distance = 0.0;
  return nearest;
}

}  // namespace fleetplan::core
