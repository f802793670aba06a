#pragma once

// The distance of a segment from rectangles and polygons, and its parts inside them.

#include <vector>

#include "core/geometry/position.h"
#include "core/runtime/stop_condition.h"

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
  double fraction = 0.0;  // share of the segment, 0 to 1
};

/// Returns the part of the segment from `from` to `to` (possibly equal) inside the rectangle.
Stretch stretch_inside(const Position& from, const Position& to, const Rectangle& rectangle);

/// Returns the nearest point of a segment (or a point, if `from` == `to`) to a rectangle, and their distance.
/// The error is a few ulp of the largest coordinate.
NearestPoint nearest_to_rectangle(const Position& from, const Position& to, const Rectangle& rectangle);

/// Whether a point is inside of a simple polygon, by its winding number. Either answer is possible within
/// rounding of the border.
bool is_inside(const std::vector<Position>& corners, const Position& point);

/// Whether a point is inside and farther than `depth` metres from the border.
bool is_deep_inside(const std::vector<Position>& corners, const Position& point, double depth);

/// Returns the first point of a segment (or a point, if `from` == `to`) that is nearest to a simple polygon
/// with its inside, and their distance; if the segment enters the polygon, the first point inside.
NearestPoint nearest_to_polygon(const Position& from, const Position& to,
                                const std::vector<Position>& corners);

/// Returns the stretches of a segment, of length > 0, whose quarter points are inside of the polygon and not
/// all within `depth` metres of its border; ascending. Returns only the first ones once `stop` is met.
std::vector<Stretch> stretches_inside(const Position& from, const Position& to,
                                      const std::vector<Position>& corners, double depth,
                                      const StopCondition& stop);

}  // namespace fleetplan::core
