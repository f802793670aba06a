#pragma once

// The disks of robots, which become larger or smaller where goals change their radius (Goal::radius_after).

#include <cstddef>

#include "core/geometry/segment.h"

namespace fleetplan::core {

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

  /// To other robots, while the robot has a radius that may be smaller.
  double pair_radius_with(double smaller) const { return pair_radius - (radius - smaller); }
};

}  // namespace fleetplan::core
