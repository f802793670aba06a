#pragma once

// Segments of the plane, alone and with times; and intervals of time.

#include <algorithm>
#include <limits>

#include "core/geometry/position.h"

namespace fleetplan::core {

inline constexpr double kForever = std::numeric_limits<double>::infinity();

/// A straight line between two positions; of length 0 for a robot that stands still.
struct Segment {
  Position from{0.0, 0.0};
  Position to{0.0, 0.0};

  double length() const { return (to - from).norm(); }
};

/// Returns the share of the segment, in [0, 1], at which it is nearest to a point.
inline double nearest_share(const Segment& segment, const Position& point) {
  const Position way = segment.to - segment.from;
  const double square = way.squaredNorm();
  return square > 0.0 ? std::clamp((point - segment.from).dot(way) / square, 0.0, 1.0) : 0.0;
}

/// Returns the distance of a point from the segment, metres.
inline double distance_to_segment(const Position& point, const Segment& segment) {
  return (segment.from + nearest_share(segment, point) * (segment.to - segment.from) - point).norm();
}

/// A segment traversed at constant speed during [t_start, t_end], seconds. A wait has from == to; only a wait
/// may have no end.
struct TimedSegment {
  Segment path;
  double t_start = 0.0;
  double t_end = 0.0;

  double duration() const { return t_end - t_start; }
  Position velocity() const {
    const double d = duration();
    return d > 0.0 && d < kForever ? Position((path.to - path.from) / d) : Position(0.0, 0.0);
  }
};

/// Closed interval [begin, end] of times at which a disk may stand at a position; end may be kForever.
struct SafeInterval {
  double begin = 0.0;
  double end = kForever;

  bool contains(double t) const { return begin <= t && t <= end; }
};

/// Open interval (begin, end) of times at which disks overlap, or of departures that lead to an overlap.
/// Open, because touching disks do not collide.
struct UnsafeInterval {
  double begin = 0.0;
  double end = 0.0;

  bool empty() const { return !(begin < end); }
  bool contains(double t) const { return begin < t && t < end; }
};

}  // namespace fleetplan::core
