#pragma once

#include <optional>
#include <vector>

#include "core/model/plan.h"
#include "core/prioritized/plan_state.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// Finds the robots that stay where they are whatever the others do, and lets them stand for ever: parked
/// robots, and those that are hopeless on the static map or beside other robots that stay. By robot, why it
/// is without a plan; none for parked robots and for those that can be planned.
std::vector<std::optional<Unplanned>> triage(PlanState& state, const StopCondition& stop);

}  // namespace fleetplan::core
