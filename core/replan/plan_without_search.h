#pragma once

#include "core/model/plan.h"
#include "core/model/plan_options.h"
#include "core/model/problem.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// The plan for which no search is needed: parked robots, and robots whose previous plans hold while all
/// others stay at their starts or committed ends. The others are unplanned for lack of a budget, with this
/// detail. Takes as long as a few checks of the plans; none of the previous plans is kept if `stop` is met
/// first.
Plan plan_without_search(const Problem& problem, const PlanOptions& options, const char* detail,
                         const StopCondition& stop);

}  // namespace fleetplan::core
