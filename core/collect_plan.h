#pragma once

#include <optional>
#include <vector>

#include "core/bounds/taut_path_bounds.h"
#include "core/model/plan.h"
#include "core/prioritized/plan_state.h"

namespace fleetplan::core {

/// The costs of the robots' trajectories, by robot; infinite for robots without one.
std::vector<double> costs_of(const PlanState& state);

/// Of the robots that follow a trajectory.
Objectives objectives_of(const PlanState& state);

/// The plan without its search statistics: every robot is unplanned, follows its trajectory, or is parked.
Plan collect_plan(const PlanState& state, const std::vector<std::optional<Unplanned>>& unplanned,
                  const TautPathBounds& bounds);

}  // namespace fleetplan::core
