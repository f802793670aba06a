#pragma once

#include "core/geometry/position.h"

namespace fleetplan::core {

/// A closed axis-aligned rectangle, metres.
struct Rectangle {
  Position low{0.0, 0.0};
  Position high{0.0, 0.0};
};

/// The part of a segment between two fractions of its length; all of it by default.
struct Stretch {
  double first = 0.0;
  double last = 1.0;
  bool empty() const { return first > last; }
};

/// The smallest distance, and the first point of the segment that has it.
struct NearestPoint {
  double distance = 0.0;  // metres, 0 inside
  double fraction = 0.0;  // of the segment, 0 to 1
};

/// The part of the segment from `from` to `to` (possibly equal) inside the rectangle.
Stretch stretch_inside(const Position& from, const Position& to, const Rectangle& rectangle);

/// The distance between a segment (or a point, if `from` == `to`) and a rectangle. The error is a few ulp of
/// the largest coordinate.
NearestPoint nearest_to_rectangle(const Position& from, const Position& to, const Rectangle& rectangle);

}  // namespace fleetplan::core
