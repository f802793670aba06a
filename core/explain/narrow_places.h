#pragma once

// Where the ways of robots without a way are too narrow.

#include <optional>
#include <vector>

#include "core/fleet/enclosure.h"
#include "core/model/plan.h"
#include "core/model/plan_options.h"
#include "core/model/problem.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// Returns, for each robot without a plan, the narrowest place of the widest way between obstacles to its
/// goal, if obstacles close it off. Of many such robots, or on large maps, only the first are examined, until
/// the stop condition is met.
std::vector<std::optional<NarrowPlace>> narrow_places(const Problem& problem, const PlanOptions& options,
                                                      const std::vector<Unplanned>& unplanned,
                                                      const StopCondition& stop);

}  // namespace fleetplan::core
