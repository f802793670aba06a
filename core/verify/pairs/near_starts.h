#pragma once

// Robots that begin nearer to each other than they have to keep, and what they may do.

#include <cstddef>
#include <optional>

#include "core/verify/check_rules.h"
#include "core/verify/execution/executed_fleet.h"
#include "core/verify/pairs/fleet_clearance.h"

namespace fleetplan::core {

/// If the overlap of two robots is one that they begin with and that they may leave: the time from which they
/// have to keep all of their distance, seconds. Otherwise none.
///
/// - Bare disks that overlap at t = 0 by as much as CheckRules::start_overlap allows keep their first
/// distance
///   until they are clear of each other once.
/// - Disks that are too near by the inflation or the vicinity only keep the least distance that their
/// committed motions have (that
///   of their starts without any) until they are clear, and until one of them has made its first translation.
std::optional<double> leaves_overlap(const ExecutedFleet& fleet, const Overlap& overlap,
                                     const CheckRules& rules);

}  // namespace fleetplan::core
