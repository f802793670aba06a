#pragma once

// Sweeps through the time of a fleet: robots that overlap moving obstacles, and robots that pass the same
// place with less than the interval margin between them.

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "core/runtime/stop_condition.h"
#include "core/verify/execution.h"
#include "core/verify/geometry/relative_motion.h"
#include "core/verify/pairs/exemptions.h"
#include "core/verify/pairs/fleet_clearance.h"

namespace fleetplan::core {

/// An overlap, by more than the tolerance, of two robots (positions in the fleet, first < second) at
/// different times.
struct ShiftedOverlap {
  std::size_t first = 0;
  std::size_t second = 0;
  double t_first = 0.0;
  double t_second = 0.0;
  double distance = 0.0;  // metres, between the centres
};

/// Returns the times of a pair that the margin leaves out: no time of either robot lies in one of them.
using LeftOut = std::function<std::vector<TimeSpan>(std::size_t first, std::size_t second)>;

/// Returns the deepest overlap within the margin of each pair, in the order of the pairs, at most `most`.
/// Times differ by `margin` or less. Left out are times at which both robots execute commitments or one of
/// them stays at the end of its commitment before it first leaves. All radii are enlarged by `inflation` and
/// the vicinity. Returns none if `stop` is met first.
std::optional<std::vector<ShiftedOverlap>> overlaps_within_margin(const ExecutedFleet& fleet, double margin,
                                                                  double inflation, const LeftOut& left_out,
                                                                  std::size_t most,
                                                                  const StopCondition& stop);

/// Returns the overlaps of robots (`first`, a position in the fleet) and obstacles (`second`) by more than
/// the tolerance of the robot: one for each uninterrupted overlap, at most `max_overlaps`. The instants at
/// which an obstacle appears and vanishes count. Times in which all overlaps of a robot are exempt are left
/// out. Exact up to rounding. Returns none if `stop` is met first.
std::optional<std::vector<Overlap>> overlaps_with_obstacles(const ExecutedFleet& fleet,
                                                            const std::vector<std::vector<Leg>>& obstacles,
                                                            const std::vector<double>& obstacle_radii,
                                                            const Exemptions& exemptions,
                                                            std::size_t max_overlaps,
                                                            const StopCondition& stop);

}  // namespace fleetplan::core
