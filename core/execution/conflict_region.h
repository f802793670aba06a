#pragma once

// Where two robots on two straight lines are too near each other, whatever their timing.

#include <optional>

#include "core/geometry/segment.h"

namespace fleetplan::core {

/// Shares of two lines: how far one robot is along the first, another one along the second. In [0, 1].
struct Shares {
  double first = 0.0;
  double second = 0.0;
};

/// The shares (u, v) with |p(u) - q(v)| < distance, where p and q go along two segments. Positions are affine
/// in u and v, so this is the inside of an ellipse, or a strip if the segments are parallel, cut to the unit
/// square: open in it, and convex. A segment of length 0 is a robot that stands.
class ConflictRegion {
 public:
  ConflictRegion(const Segment& first, const Segment& second, double distance);

  /// A closed range of shares.
  struct Range {
    double least = 0.0;
    double most = 0.0;
  };
  /// The shares of the second line that belong to the part of the region with `from` <= u <= 1; nothing if
  /// that is empty.
  std::optional<Range> second_beyond(double from) const;
  /// The shares of the first line that belong to the part of the region with 0 <= v <= `to`.
  std::optional<Range> first_up_to(double to) const;

 private:
  Position offset_;  // p(0) - q(0)
  Position first_;   // from the begin to the end of the first segment
  Position second_;
  double distance_;
};

/// Where two segments are nearest.
struct NearestShares {
  Shares at;
  double distance = 0.0;
};
NearestShares nearest_shares(const Segment& first, const Segment& second);

}  // namespace fleetplan::core
