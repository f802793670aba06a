#include "core/verify/geometry/segment_distance.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
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

/// Returns the part of `stretch` whose coordinate, linear from `from` to `to`, is between `low` and `high`.
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

  // The distance of two disjoint convex shapes is that of a corner of one of them from the other.
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

namespace {

double perp_dot(const Position& a, const Position& b) { return a.x() * b.y() - a.y() * b.x(); }

const Position& next_corner(const std::vector<Position>& corners, std::size_t k) {
  return corners[(k + 1) % corners.size()];
}

/// Returns the fraction of a segment at which it is nearest to a point.
double nearest_fraction(const Position& point, const Position& from, const Position& to) {
  const Position d = to - from;
  const double squared = d.squaredNorm();
  return squared > 0.0 ? std::clamp(d.dot(point - from) / squared, 0.0, 1.0) : 0.0;
}

double distance_from_edge(const Position& point, const Position& a, const Position& b) {
  return (a + nearest_fraction(point, a, b) * (b - a) - point).norm();
}

double distance_from_border(const std::vector<Position>& corners, const Position& point) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < corners.size(); ++k) {
    least = std::min(least, distance_from_edge(point, corners[k], next_corner(corners, k)));
  }
  return least;
}

/// Returns the fraction of the segment at which it crosses an edge; none if they are parallel or do not meet.
std::optional<double> crossing(const Position& from, const Position& to, const Position& a,
                               const Position& b) {
  const Position along = to - from;
  const Position edge = b - a;
  const double turn = perp_dot(along, edge);
  if (turn == 0.0) return std::nullopt;
  const double at = perp_dot(a - from, edge) / turn;
  const double on_edge = perp_dot(a - from, along) / turn;
  if (at < 0.0 || at > 1.0 || on_edge < 0.0 || on_edge > 1.0) return std::nullopt;
  return at;
}

/// Returns the nearest point of the segment to an edge of the border.
NearestPoint nearest_to_edge(const Position& from, const Position& to, const Position& a, const Position& b) {
  if (const auto at = crossing(from, to, a, b)) return {0.0, *at};
  NearestPoint nearest{distance_from_edge(from, a, b), 0.0};
  const auto consider = [&](double distance, double fraction) {
    if (distance < nearest.distance || (distance == nearest.distance && fraction < nearest.fraction)) {
      nearest = {distance, fraction};
    }
  };
  consider(distance_from_edge(to, a, b), 1.0);
  for (const Position* end : {&a, &b}) {
    const double fraction = nearest_fraction(*end, from, to);
    consider((from + fraction * (to - from) - *end).norm(), fraction);
  }
  return nearest;
}

}  // namespace

bool is_inside(const std::vector<Position>& corners, const Position& point) {
  int winding = 0;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const Position a = corners[k] - point;
    const Position b = next_corner(corners, k) - point;
    if (a.y() <= 0.0 && b.y() > 0.0 && perp_dot(a, b) > 0.0) ++winding;
    if (a.y() > 0.0 && b.y() <= 0.0 && perp_dot(a, b) < 0.0) --winding;
  }
  return winding != 0;
}

bool is_deep_inside(const std::vector<Position>& corners, const Position& point, double depth) {
  return is_inside(corners, point) && distance_from_border(corners, point) > depth;
}

NearestPoint nearest_to_polygon(const Position& from, const Position& to,
                                const std::vector<Position>& corners) {
  if (is_inside(corners, from)) return {0.0, 0.0};
  NearestPoint nearest{std::numeric_limits<double>::infinity(), 0.0};
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const NearestPoint found = nearest_to_edge(from, to, corners[k], next_corner(corners, k));
    const bool is_nearer = found.distance < nearest.distance;
    if (is_nearer || (found.distance == nearest.distance && found.fraction < nearest.fraction)) {
      nearest = found;
    }
  }
  return nearest;
}

std::vector<Stretch> stretches_inside(const Position& from, const Position& to,
                                      const std::vector<Position>& corners, double depth,
                                      const StopCondition& stop) {
  std::vector<double> ends{0.0, 1.0};
  for (std::size_t k = 0; k < corners.size(); ++k) {
    // The stretches end at crossings, and at the ends of edges that the segment passes along.
    if (const auto at = crossing(from, to, corners[k], next_corner(corners, k))) ends.push_back(*at);
    ends.push_back(nearest_fraction(corners[k], from, to));
  }
  std::sort(ends.begin(), ends.end());
  std::vector<Stretch> inside;
  for (std::size_t k = 0; k + 1 < ends.size() && !stop.met(); ++k) {
    const double length = ends[k + 1] - ends[k];
    if (length <= 0.0) continue;
    bool is_deep = false;
    bool all_inside = true;
    for (const double quarter : {0.25, 0.5, 0.75}) {
      const Position point = from + (ends[k] + quarter * length) * (to - from);
      all_inside = all_inside && is_inside(corners, point);
      is_deep = is_deep || (all_inside && distance_from_border(corners, point) > depth);
    }
    if (!all_inside || !is_deep) continue;
    if (!inside.empty() && inside.back().last == ends[k]) {
      inside.back().last = ends[k + 1];
    } else {
      inside.push_back({ends[k], ends[k + 1]});
    }
  }
  return inside;
}

}  // namespace fleetplan::core
