#pragma once

// Segments of the plane: alone, with times, and with the disks of robots. Intervals of time.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "core/geometry/position.h"

namespace fleetplan::core {

inline constexpr double kForever = std::numeric_limits<double>::infinity();

/// A straight line between two positions. Its length is 0 for a robot that stands still.
struct Segment {
  Position from{0.0, 0.0};
  Position to{0.0, 0.0};

  double length() const { return (to - from).norm(); }
  /// The point after a share of the way.
  Position at(double share) const { return from + share * (to - from); }
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

/// The progress of one robot along a first segment, and of another robot along a second segment, as shares in
/// [0, 1].
struct Shares {
  double first = 0.0;
  double second = 0.0;
};

/// Where two segments are nearest to each other, and their distance there, metres.
struct NearestShares {
  Shares at;
  double distance = 0.0;
};

/// Returns where two segments are nearest to each other: where they cross, or else at an end of one segment.
inline NearestShares nearest_shares(const Segment& first, const Segment& second) {
  constexpr double kParallelLines = 1e-12;  // the sine of the angle of lines that are parallel: rounding
  const Position d = first.to - first.from;
  const Position e = second.to - second.from;
  const Position offset = second.from - first.from;
  const double slope = cross_product(d, e);
  if (std::abs(slope) > kParallelLines * std::sqrt(d.squaredNorm() * e.squaredNorm())) {
    const double u = cross_product(offset, e) / slope;
    const double v = cross_product(offset, d) / slope;
    if (u >= 0.0 && u <= 1.0 && v >= 0.0 && v <= 1.0) return {{u, v}, 0.0};
  }
  NearestShares best{{0.0, nearest_share(second, first.from)}, 0.0};
  best.distance = (second.at(best.at.second) - first.from).norm();
  const auto improve = [&](const Shares& at) {
    const double distance = (first.at(at.first) - second.at(at.second)).norm();
    if (distance < best.distance) best = {at, distance};
  };
  improve({1.0, nearest_share(second, first.to)});
  improve({nearest_share(first, second.from), 0.0});
  improve({nearest_share(first, second.to), 1.0});
  return best;
}

/// The share of a way that is covered after a share of its time, both in [0, 1], at constant acceleration.
/// For `ramp` see TimedSegment.
inline double covered_share(double elapsed, double ramp) {
  return ramp == 0.0 ? elapsed : elapsed * (1.0 - ramp * (1.0 - elapsed));
}

/// The inverse: the share of the time that it takes to cover a share of the way.
inline double elapsed_share(double covered, double ramp) {
  if (ramp == 0.0) return covered;
  if (covered <= 0.0) return 0.0;
  const double start = 1.0 - ramp;
  const double root = std::sqrt(std::max(0.0, start * start + 4.0 * ramp * covered));
  return std::min(1.0, 2.0 * covered / (start + root));
}

/// A segment traversed at constant acceleration, usually 0, during [t_start, t_end], seconds. A wait has from
/// == to. Only a wait may have no end.
struct TimedSegment {
  Segment path;
  double t_start = 0.0;
  double t_end = 0.0;
  /// How much the speed changes, in [-1, 1]. The speed is (1 - ramp) times the mean speed at the beginning,
  /// and (1 + ramp) times at the end. 0: constant speed; 1: from rest; -1: to rest.
  double ramp = 0.0;

  double duration() const { return t_end - t_start; }
  /// The part from `t` on. `t` is within the segment.
  TimedSegment from_time(double t) const {
    const double elapsed = (t - t_start) / duration();
    const double speed = 1.0 - ramp * (1.0 - 2.0 * elapsed);  // at `t`, as a share of the mean speed
    return {{path.at(covered_share(elapsed, ramp)), path.to},
            t,
            t_end,
            (1.0 + ramp - speed) / (1.0 + ramp + speed)};
  }
  /// The part until `t`, which is within it.
  TimedSegment until_time(double t) const {
    const double elapsed = (t - t_start) / duration();
    const double speed = 1.0 - ramp * (1.0 - 2.0 * elapsed);
    return {{path.from, path.at(covered_share(elapsed, ramp))},
            t_start,
            t,
            (speed - 1.0 + ramp) / (speed + 1.0 - ramp)};
  }
  /// The mean velocity, metres per second.
  Position velocity() const {
    const double d = duration();
    return d > 0.0 && d < kForever ? Position((path.to - path.from) / d) : Position(0.0, 0.0);
  }
};

/// A timed segment and the radius that the robot has on it.
struct SizedSegment : TimedSegment {
  double radius = 0.0;  // metres; neither inflation nor vicinity included
};

/// The disk with which a robot stands or moves somewhere.
struct Footprint {
  std::size_t robot = 0;
  double radius = 0.0;    // metres; neither inflation nor vicinity included
  bool has_left = false;  // the robot's start, even if it stands there again
};

/// The largest disk that a robot ever has.
struct LargestDisk {
  double radius = 0.0;       // metres; neither inflation nor vicinity included
  double pair_radius = 0.0;  // metres, to other robots: with inflation and vicinity

  /// The radius towards other robots, if the robot has a radius that may be smaller.
  double pair_radius_with(double smaller) const { return pair_radius - (radius - smaller); }
};

/// Closed interval [begin, end] of times at which a disk may stand at a position; end may be kForever.
struct SafeInterval {
  double begin = 0.0;
  double end = kForever;

  bool contains(double t) const { return begin <= t && t <= end; }
};

/// Open interval (begin, end) of times at which disks overlap, or of departures that lead to an overlap. It
/// is open because touching disks do not collide.
struct UnsafeInterval {
  double begin = 0.0;
  double end = 0.0;

  bool empty() const { return !(begin < end); }
  bool contains(double t) const { return begin < t && t < end; }
};

}  // namespace fleetplan::core
