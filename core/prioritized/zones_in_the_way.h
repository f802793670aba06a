#pragma once

#include <optional>
#include <vector>

#include "core/model/plan.h"
#include "core/model/plan_options.h"
#include "core/model/problem.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// Returns the list with more details for robots that walls or zones leave no way: the zones without which
/// each of them would have one, none of these superfluous. Of many such robots and zones, only the first are
/// examined, until the stop condition is met.
std::vector<std::optional<Unplanned>> with_zones_named(const Problem& problem, const PlanOptions& options,
                                                       std::vector<std::optional<Unplanned>> unplanned,
                                                       const StopCondition& stop);

}  // namespace fleetplan::core
