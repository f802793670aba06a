#pragma once

// The smallest gap between robots over all time, and where they overlap.

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "core/runtime/stop_condition.h"
#include "core/verify/execution/execution.h"
#include "core/verify/pairs/overlap_list.h"

namespace fleetplan::core {

struct FleetClearance {
  std::optional<double> least;    // metres: smallest gap between two bodies; none for fewer than two robots
  std::vector<Overlap> overlaps;  // of positions in the list of radii, first < second; in no particular order
};

/// The radii of robots, metres.
struct DiskRadii {
  const std::vector<double>& body;
  const std::vector<double>& kept_apart;  // that must not overlap, each >= that of the body
};

/// Whether an overlap of two robots that rest for ever is left out of the list.
using LeftOutAtRest = std::function<bool(const Overlap&)>;

/// Exact up to rounding: a few ulp of the coordinates. `legs_by_robot` are results of `execute`, `radii` and
/// `tolerances` (metres) are in the same order; two robots may overlap by the larger one of theirs. At most
/// `max_overlaps` are listed: those that are missing begin later than those listed, or slightly earlier.
/// `least` always includes all pairs and all time, and does not depend on the order of the robots. Overlaps
/// for which `left_out` (which may be empty) holds are not listed. Returns none if `stop` is met first.
std::optional<FleetClearance> fleet_clearance(const std::vector<std::vector<Leg>>& legs_by_robot,
                                              const DiskRadii& radii, const std::vector<double>& tolerances,
                                              std::size_t max_overlaps, const StopCondition& stop,
                                              const LeftOutAtRest& left_out = {});

}  // namespace fleetplan::core
