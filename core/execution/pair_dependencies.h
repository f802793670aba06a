#pragma once

// The dependencies between two robots. If two of their stretches are too near each other, whatever the
// timing, the progress of both must keep out of a region. The fewest steps that keep it out of all such
// regions are a staircase.

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/execution/executed_actions.h"
#include "core/geometry/segment.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// The shares (u, v) with |p(u) - q(v)| < distance, where p and q move along two segments. Positions are
/// affine in u and v. So this is the inside of an ellipse, or a strip if the segments are parallel, cut to
/// the unit square. It is convex, and open in the square. A segment of length 0 is a robot that stands.
class ConflictRegion {
 public:
  ConflictRegion(const Segment& first, const Segment& second, double distance);

  /// A closed range of shares.
  struct Range {
    double least = 0.0;
    double most = 0.0;
  };
  /// Returns the shares of the second line in the part of the region with `from` <= u <= 1. None if this part
  /// is empty.
  std::optional<Range> second_beyond(double from) const;
  /// Returns the shares of the first line in the part of the region with 0 <= v <= `to`. None if this part is
  /// empty.
  std::optional<Range> first_up_to(double to) const;

 private:
  Position offset_;  // p(0) - q(0)
  Position first_;   // from the begin to the end of the first segment
  Position second_;
  double distance_;
};

/// A region of whole progress (u, v) through which the robot of u goes first: it passes the region before the
/// other robot enters.
class PassedRegion {
 public:
  /// A stretch in whole progress: where it begins, and its length.
  struct Part {
    double begin = 0.0;
    double length = 1.0;
  };

  PassedRegion(const ConflictRegion& shares, const Part& first, const Part& second);

  /// Returns the least v of the points with more than this u; infinity if there are none.
  double second_after(double first) const;
  /// Returns the greatest u of the points with at most this v; minus infinity if there are none.
  double first_before(double second) const;

  /// Bounds that rounding respects. second_after() is never less than `least_second`, and infinite from
  /// `most_first` on. first_before() is never more than `most_first`, and infinite up to `least_second`.
  double least_second() const { return least_second_; }
  double most_first() const { return most_first_; }
  /// Whether the region continues for all u before its first stretch, and for all v after its second stretch.
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

/// A lack of slack: its planned time, and the slack that there is, seconds.
struct Tightness {
  double t = 0.0;
  double slack = 0.0;
};

struct Staircase {
  std::vector<Step> steps;       // both ascending
  std::vector<Tightness> tight;  // one for each uninterrupted lack of slack, at its least
};

/// Returns the fewest steps that keep (u, v) out of all regions, each with the planned slack (seconds, > 0).
/// If the whole slack would need many small steps, a step has half of it.
///
/// If the plan has less slack, a step demands only the slack of the plan, so that both robots can go on. The
/// regions are not excluded there, and the staircase is tight. Returns none if the stop condition is met.
std::optional<Staircase> staircase_of(const std::vector<PassedRegion>& regions, const Pace& first,
                                      const Pace& second, double slack, const StopCondition& stop);

/// Two stretches of different robots whose disks would touch at some progress. There may be millions.
struct NearPair {
  std::uint32_t other_stretch = 0;  // of the first robot
  std::uint32_t stretch = 0;        // of the second robot, ascending in a list
};

/// The dependencies between two robots.
struct PairDependencies {
  std::vector<Step> for_second;  // the second robot waits for the first
  std::vector<Step> for_first;
  std::vector<Tightness> tight;
};

/// One of two robots: its motion in stretches, and the planned times.
struct PacedRobot {
  const std::vector<PlannedStretch>& stretches;
  const Pace& pace;
};

/// Returns the dependencies between two robots that keep them apart by the sum of their radii minus
/// `tolerance` (metres). `near`: stretches of the first robot (NearPair::other_stretch) near stretches of the
/// second robot. Returns none if the stop condition is met.
std::optional<PairDependencies> pair_dependencies(const PacedRobot& first, const PacedRobot& second,
                                                  std::span<const NearPair> near, double tolerance,
                                                  double slack, const StopCondition& stop);

}  // namespace fleetplan::core
