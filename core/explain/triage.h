#pragma once

// Robots that cannot move, and why.

#include <cstddef>
#include <optional>
#include <vector>

#include "core/fleet/plan_state.h"
#include "core/model/plan.h"
#include "core/model/plan_options.h"
#include "core/model/problem.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// Finds the robots that cannot move whatever the others do, and keeps them at their starts in `state`:
///
/// - parked robots,
/// - robots whose start or goal is blocked,
/// - robots whose goal is unreachable on the static map, or because of robots that stay.
///
/// Returns, by robot, why it has no plan; none for parked robots and for robots that are left to be planned.
std::vector<std::optional<Unplanned>> triage(PlanState& state, const StopCondition& stop,
                                             const std::vector<bool>& kept = {});

/// Returns why a robot of this radius (metres, inflation included) without a way to its goal has no plan.
Unplanned unplanned_without_way(std::size_t robot, double radius, const Way& way);

/// Returns the list with more details for robots that walls or zones leave no way. The details name zones
/// without which the robot would have a way; each of them is necessary. Of many such robots and zones, only
/// the first are examined, until the stop condition is met.
std::vector<std::optional<Unplanned>> with_zones_named(const Problem& problem, const PlanOptions& options,
                                                       std::vector<std::optional<Unplanned>> unplanned,
                                                       const StopCondition& stop);

}  // namespace fleetplan::core
