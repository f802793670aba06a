#pragma once

#include <optional>
#include <vector>

#include "core/execution/conflict_region.h"
#include "core/execution/executed_actions.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

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
