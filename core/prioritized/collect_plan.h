#pragma once

#include <optional>
#include <vector>

#include "core/bounds/taut_path_bounds.h"
#include "core/model/plan.h"
#include "core/prioritized/plan_state.h"

namespace fleetplan::core {

/// Returns the plan of a state without its search statistics: every robot is unplanned, follows its
/// trajectory, or is parked. `unplanned` is by robot.
Plan collect_plan(const PlanState& state, const std::vector<std::optional<Unplanned>>& unplanned,
                  const TautPathBounds& bounds);

}  // namespace fleetplan::core
