#pragma once

// Where two robots on two straight lines are too near each other, whatever their timing; and the steps by
// which they keep out of all such regions.

#include <optional>
#include <vector>

#include "core/execution/executed_actions.h"
#include "core/geometry/segment.h"
#include "core/runtime/stop_condition.h"

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

/// A region of whole progress (u, v) through which the robot of u goes first: one robot passes it before
/// another one enters.
class PassedRegion {
 public:
  /// Where a stretch begins in whole progress, and its length.
  struct Part {
    double begin = 0.0;
    double length = 1.0;
  };

  PassedRegion(const ConflictRegion& shares, const Part& first, const Part& second);

  /// The least v of points with more than this u; infinity if there are none.
  double second_after(double first) const;
  /// The greatest u of points with at most this v; minus infinity if there are none.
  double first_before(double second) const;

  /// Bounds that rounding respects: second_after is never less than `least_second`, and infinite from
  /// `most_first` on; first_before is never more than `most_first`, and infinite up to `least_second`.
  double least_second() const { return least_second_; }
  double most_first() const { return most_first_; }
  /// Whether there are points for all u up to its begin, and for all v from its end on.
  bool is_open() const { return is_open_; }

 private:
  ConflictRegion shares_;
  Part first_;
  Part second_;
  double least_second_ = 0.0;
  double most_first_ = 0.0;
  bool is_open_ = false;
};

/// One step: v may not pass `gate` until u is at least `until`.
struct Step {
  double gate = 0.0;
  double until = 0.0;
};

/// When there is less slack than required, and how much. Seconds.
struct Tightness {
  double t = 0.0;
  double slack = 0.0;
};

struct Staircase {
  std::vector<Step> steps;       // both ascending
  std::vector<Tightness> tight;  // one for each uninterrupted lack of slack; the least one
};

/// The fewest steps that keep (u, v) out of all regions, each with the planned slack (seconds, > 0), or with
/// half of it where the whole would mean many small steps. Where the plan has less, a step demands what the
/// plan has, so that everybody can go on; then the regions are not excluded, and the staircase is tight
/// there. Nothing if the stop condition is met.
std::optional<Staircase> staircase_of(const std::vector<PassedRegion>& regions, const Pace& first,
                                      const Pace& second, double slack, const StopCondition& stop);

}  // namespace fleetplan::core
