#pragma once

#include "core/geometry/segment.h"

namespace fleetplan::core {

/// Closed interval [begin, end] of time during which a disk may stand at a place; end may be kForever.
struct SafeInterval {
  double begin = 0.0;
  double end = kForever;

  bool contains(double t) const { return begin <= t && t <= end; }
};

/// Open interval (begin, end) of times at which disks would overlap, or of departures that lead to that.
/// Open, since touching disks do not collide.
struct UnsafeInterval {
  double begin = 0.0;
  double end = 0.0;

  bool empty() const { return !(begin < end); }
  bool contains(double t) const { return begin < t && t < end; }
};

}  // namespace fleetplan::core
