#pragma once

// Which robots keep robots that are stuck within the horizon from their goals.

#include "core/fleet/plan_state.h"
#include "core/model/plan.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// Returns the plan with the reasons of its stuck robots: RobotPlan::blocked_by, and no estimates where
/// robots that stay for good close the way. `state` follows the plan. Reasons that take longer than `stop`
/// allows, or more memory than there is, are left out. The plan is then not deterministic.
Plan with_stuck_explained(PlanState& state, Plan plan, const StopCondition& stop);

}  // namespace fleetplan::core
