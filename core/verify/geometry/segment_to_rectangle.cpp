#include "core/verify/geometry/segment_to_rectangle.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace fleetplan::core {
namespace {

double distance_to_rectangle(const Position& point, const Rectangle& rectangle) {
  const double dx = std::max({rectangle.low.x() - point.x(), point.x() - rectangle.high.x(), 0.0});
  const double dy = std::max({rectangle.low.y() - point.y(), point.y() - rectangle.high.y(), 0.0});
  return std::sqrt(dx * dx + dy * dy);
}

NearestPoint nearest_to_point(const Position& from, const Position& to, const Position& point) {
  const Position way = to - from;
  const double fraction = std::clamp((point - from).dot(way) / way.squaredNorm(), 0.0, 1.0);
  return {(from + fraction * way - point).norm(), fraction};
}

NearestPoint nearer_or_earlier(const NearestPoint& a, const NearestPoint& b) {
  if (a.distance != b.distance) return a.distance < b.distance ? a : b;
  return a.fraction <= b.fraction ? a : b;
}

/// The part of `stretch` whose coordinate, linear from `from` to `to`, is between `low` and `high`.
Stretch narrowed(const Stretch& stretch, double from, double to, double low, double high) {
  const double way = to - from;
  if (way == 0.0) return from < low || from > high ? Stretch{1.0, 0.0} : stretch;
  const double at_low = (low - from) / way;
  const double at_high = (high - from) / way;
  return {std::max(stretch.first, std::min(at_low, at_high)),
          std::min(stretch.last, std::max(at_low, at_high))};
}

}  // namespace

Stretch stretch_inside(const Position& from, const Position& to, const Rectangle& rectangle) {
  const Stretch in_x = narrowed({}, from.x(), to.x(), rectangle.low.x(), rectangle.high.x());
  return narrowed(in_x, from.y(), to.y(), rectangle.low.y(), rectangle.high.y());
}

NearestPoint nearest_to_rectangle(const Position& from, const Position& to, const Rectangle& rectangle) {
  const NearestPoint at_start{distance_to_rectangle(from, rectangle), 0.0};
  if ((to - from).squaredNorm() <= 0.0) return at_start;
  const Stretch inside = stretch_inside(from, to, rectangle);
  if (!inside.empty()) return {0.0, inside.first};

  // For two disjoint convex shapes, a corner of one of them is nearest to the other.
  const NearestPoint at_end{distance_to_rectangle(to, rectangle), 1.0};
  NearestPoint nearest = nearer_or_earlier(at_start, at_end);
  const auto [left, bottom] = std::pair{rectangle.low.x(), rectangle.low.y()};
  const auto [right, top] = std::pair{rectangle.high.x(), rectangle.high.y()};
  for (const Position& corner :
       {Position(left, bottom), Position(right, bottom), Position(left, top), Position(right, top)}) {
    nearest = nearer_or_earlier(nearest, nearest_to_point(from, to, corner));
  }
  return nearest;
}

}  // namespace fleetplan::core
