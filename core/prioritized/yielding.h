#pragma once

#include "core/prioritized/plan_state.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// Lets robots that make way (Robot::yields) stay where they are done, or nearer, if the others of the plan
/// in `state` do not need that any more, until no such robot is left. Previous plans are left as they are.
/// Returns whether `stop` ended it early.
bool undo_vain_moves(PlanState& state, const StopCondition& stop);

}  // namespace fleetplan::core
