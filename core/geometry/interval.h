#pragma once

#include "core/geometry/segment.h"

namespace fleetplan::core {

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
