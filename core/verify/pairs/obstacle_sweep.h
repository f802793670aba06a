#pragma once

// Where robots overlap moving obstacles.

#include <cstddef>
#include <optional>
#include <vector>

#include "core/runtime/stop_condition.h"
#include "core/verify/execution.h"
#include "core/verify/pairs/exemptions.h"
#include "core/verify/pairs/fleet_clearance.h"

namespace fleetplan::core {

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
