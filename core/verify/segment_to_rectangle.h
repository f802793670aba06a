#pragma once

#include "core/geometry/position.h"

namespace fleetplan::core {

/// A closed axis-aligned rectangle, metres.
struct Rectangle {
  Position low{0.0, 0.0};
  Position high{0.0, 0.0};
};

/// The part of the way from `from` to `to` between two fractions of it; the whole by default.
struct Stretch {
  double first = 0.0;
  double last = 1.0;
  bool empty() const { return first > last; }
};

/// How near, and after which fraction of the way for the first time.
struct NearestPoint {
  double distance = 0.0;  // metres, 0 inside
  double fraction = 0.0;  // of the way, 0 to 1
};

/// The part of the way from `from` to `to` (which may be the same point) that lies in the rectangle.
Stretch stretch_inside(const Position& from, const Position& to, const Rectangle& rectangle);

/// The distance between a segment (or a point, if `from` == `to`) and a rectangle; off by a few ulp of the
/// largest coordinate.
NearestPoint nearest_to_rectangle(const Position& from, const Position& to, const Rectangle& rectangle);

}  // namespace fleetplan::core
