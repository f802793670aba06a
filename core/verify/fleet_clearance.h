#pragma once

// How near the robots come to each other, over all time, and where they overlap.

#include <cstddef>
#include <optional>
#include <vector>

#include "core/runtime/stop_condition.h"
#include "core/verify/execution.h"

namespace fleetplan::core {

/// Two robots overlap by more than the tolerance without a break from t_begin to t_end.
struct Overlap {
  std::size_t first = 0;  // positions in the list of radii, first < second
  std::size_t second = 0;
  double t_begin = 0.0;
  double t_end = 0.0;  // infinity where it never ends
  double t_deepest = 0.0;
  double distance = 0.0;  // metres, between the centres at t_deepest
};

struct FleetClearance {
  std::optional<double> least;    // metres: smallest gap between two disks; none below two robots
  std::vector<Overlap> overlaps;  // in no particular order
};

/// Exact up to rounding: a few ulp of the coordinates. `legs_by_robot` as `execute` makes them, `radii` in
/// the same order. Once `most_overlaps` are found, further ones are not listed: those missing begin later
/// than those listed, or hardly earlier. `least` is always that of all pairs and all time, whatever their
/// order. Nothing if `stop` was met before it was done.
std::optional<FleetClearance> fleet_clearance(const std::vector<std::vector<Leg>>& legs_by_robot,
                                              const std::vector<double>& radii, double tolerance,
                                              std::size_t most_overlaps, const StopCondition& stop);

}  // namespace fleetplan::core
