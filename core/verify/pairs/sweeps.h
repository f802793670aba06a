#pragma once

// Sweeps through the time of a fleet. They find robots that overlap moving obstacles, and robots that pass
// the same place with less than the interval margin between them. Some pairs may do so, at the times of their
// unavoidable collisions.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <unordered_map>
#include <vector>

#include "core/model/plan.h"
#include "core/runtime/stop_condition.h"
#include "core/verify/execution.h"
#include "core/verify/geometry/relative_motion.h"
#include "core/verify/pairs/fleet_clearance.h"

namespace fleetplan::core {

/// The times at which pairs may collide, see CheckRules::exempt. Unavoidable collisions count only if they
/// begin while both bodies are in certain motion:
///
/// - obstacles that move,
/// - robots that execute their commitments,
/// - robots without a plan or a goal, which stay for ever at the end of these.
///
/// If a robot has kMaxUnavoidableOfRobot collisions, no more are listed. So all its certain motion is exempt
/// from the last one on.
class Exemptions {
 public:
  /// Finds the times. `obstacles` are the legs of the moving obstacles, `obstacle_radii` their radii. All
  /// robots are enlarged by `inflation` and, against robots, by their vicinity. Incomplete if `stop` is met.
  Exemptions(const std::vector<UnavoidableCollision>& collisions, const ExecutedFleet& fleet,
             double inflation, const std::vector<std::vector<Leg>>& obstacles,
             const std::vector<double>& obstacle_radii, const StopCondition& stop);

  /// The times at which two robots may collide. They are given by their positions in the fleet, in any order.
  const std::vector<TimeSpan>& of_robots(std::size_t one, std::size_t other) const;
  const std::vector<TimeSpan>& with_obstacle(std::size_t robot, std::size_t obstacle) const;

  /// Whether an overlap of this pair that begins at `t` is exempt.
  bool allow_robots(std::size_t one, std::size_t other, double t) const;
  bool allow_obstacle(std::size_t robot, std::size_t obstacle, double t) const;
  /// Whether all overlaps of the robot with obstacles in this time are exempt.
  bool allow_all_obstacles(std::size_t robot, const TimeSpan& time) const {
    return certain_[robot].exempt_from <= time.begin && time.end <= certain_[robot].until;
  }

 private:
  using Spans = std::unordered_map<std::uint64_t, std::vector<TimeSpan>>;

  /// The end of a robot's certain motion, and the time from which on its collisions are exempt.
  struct Certain {
    double until = 0.0;
    double exempt_from = 0.0;
  };
  void count(std::size_t position, double t, std::vector<std::size_t>& collisions);
  bool is_certain(std::size_t position, double t) const;
  void add_pair(std::size_t one, std::size_t other_robot, double t);
  void add_obstacle(std::size_t position, std::size_t obstacle, double t);
  void add_robots(std::size_t one, std::size_t other, double t);

  static const std::vector<TimeSpan>& find(const Spans& spans, std::uint64_t pair);
  std::uint64_t key(std::size_t one, std::size_t other) const;

  const ExecutedFleet& fleet_;
  const double inflation_;
  const std::vector<std::vector<Leg>>& obstacles_;
  const std::vector<double>& obstacle_radii_;
  std::size_t robots_;
  std::vector<Certain> certain_;  // by position
  Spans of_robots_;
  Spans with_obstacles_;
};

/// Whether an overlap that begins at `t` lies in one of the spans.
bool any_contains(const std::vector<TimeSpan>& spans, double t);

/// An overlap, by more than the tolerance, of two robots (positions in the fleet, first < second) at
/// different times.
struct ShiftedOverlap {
  std::size_t first = 0;
  std::size_t second = 0;
  double t_first = 0.0;
  double t_second = 0.0;
  double distance = 0.0;  // metres, between the centres
};

/// Returns the times of a pair that the margin leaves out: no time of either robot lies in any of them.
using TimesLeftOut = std::function<std::vector<TimeSpan>(std::size_t first, std::size_t second)>;

/// Returns the deepest overlap within the margin of each pair, in the order of the pairs, at most
/// `max_overlaps`. Times differ by `margin` or less. Times are left out at which both robots execute
/// commitments, or one of them stays at the end of its commitment before it first leaves. All radii are
/// enlarged by `inflation` and the vicinity. Returns none if `stop` is met first.
std::optional<std::vector<ShiftedOverlap>> overlaps_within_margin(const ExecutedFleet& fleet, double margin,
                                                                  double inflation,
                                                                  const TimesLeftOut& left_out,
                                                                  std::size_t max_overlaps,
                                                                  const StopCondition& stop);

/// Returns the overlaps of robots (`first`, a position in the fleet) and obstacles (`second`) by more than
/// the tolerance of the robot. There is one for each uninterrupted overlap, at most `max_overlaps`. The
/// instants at which an obstacle appears and vanishes count. Times in which all overlaps of a robot are
/// exempt are left out. Exact up to rounding. Returns none if `stop` is met first.
std::optional<std::vector<Overlap>> overlaps_with_obstacles(const ExecutedFleet& fleet,
                                                            const std::vector<std::vector<Leg>>& obstacles,
                                                            const std::vector<double>& obstacle_radii,
                                                            const Exemptions& exemptions,
                                                            std::size_t max_overlaps,
                                                            const StopCondition& stop);

}  // namespace fleetplan::core
