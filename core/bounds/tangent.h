#pragma once

#include <cmath>
#include <optional>

#include "core/bounds/corner_visibility.h"
#include "core/geometry/position.h"

namespace fleetplan::core {

/// One of the two ways around a corner: the quarter of the circle of the disk's radius around the corner that
/// faces away from the blocked cell, with the corner on the left or on the right. A place on it is an angle
/// from -pi/4, where the quarter begins, to pi/4, where it ends.
struct Bend {
  int corner = 0;
  bool left = false;  // the corner is on the left
};

/// A straight move that is tangent to the circles of the corners that it links, or ends at a given point.
struct Tangent {
  Bend to;                    // meaningless where the move ends at a point
  double leave_angle = 0.0;   // the place on the bend that it starts from; 0 from a point
  double arrive_angle = 0.0;  // the place on `to`; 0 at a point
  double length = 0.0;        // metres
  double heading = 0.0;
  Position begin{0.0, 0.0};
  Position end{0.0, 0.0};
};

/// The headings that a disk has on a bend lie in one quadrant: the signs of their cosine and sine, and the
/// heading in the middle.
struct Quadrant {
  double x;
  double y;
  double middle;  // radians
};

/// A circle that a tangent touches, or a point where it ends.
struct TangentEnd {
  Position center;
  double offset;             // of the circle's centre to the left of the move, metres; 0: a point
  const Quadrant* quadrant;  // null: a point
};

/// `offset` as in TangentEnd; `corner` is at `center`.
TangentEnd circle_around(const Corner& corner, const Position& center, double offset);
inline TangentEnd at_point(const Position& point) { return {point, 0.0, nullptr}; }

/// Rounding of the direction of a tangent that crosses between two circles that nearly touch (radians).
inline constexpr double kDirectionRounding = 1e-7;

/// Whether `direction` is a heading of the bend, if each of its components may be off by `slack`.
inline bool is_heading_of(const TangentEnd& end, const Position& direction, double slack) {
  return end.quadrant == nullptr ||
         (direction.x() * end.quadrant->x >= -slack && direction.y() * end.quadrant->y >= -slack);
}

/// By how much a component of the vector `d` between two centres may differ from that of a tangent of their
/// circles, whose offsets differ by `across`.
inline double tangent_slack(const Position& d, double across) {
  return across + kDirectionRounding * (std::abs(d.x()) + std::abs(d.y()));
}

/// A necessary condition for a tangent, quickly computed.
inline bool may_be_tangent(const TangentEnd& from, const TangentEnd& to) {
  const Position d = to.center - from.center;
  const double slack = tangent_slack(d, std::abs(to.offset - from.offset));
  return is_heading_of(from, d, slack) && is_heading_of(to, d, slack);
}

/// The tangent without `to`; none if it does not exist or touches a circle outside its bend. Also none if it
/// runs along an axis and only grazes the beginning of the bend that it leaves or the end of the one that it
/// arrives at: no taut path bends there, as one longer move does the same.
std::optional<Tangent> common_tangent(const TangentEnd& from, const TangentEnd& to);

}  // namespace fleetplan::core
