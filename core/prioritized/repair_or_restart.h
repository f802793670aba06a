#pragma once

#include "core/prioritized/ordering_result.h"
#include "core/prioritized/plan_state.h"
#include "core/prioritized/priority_order.h"
#include "core/prioritized/progress_report.h"
#include "core/runtime/random.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// Plans all robots of `order`, which have no reservations, with repairs (see repair.h). If the robots differ
/// in size and many attempts fail, starts again once in an order with larger robots first, as small robots
/// find other paths more easily. `unsolved` is empty unless `stop` was met.
OrderingResult repair_or_restart(PlanState& state, const PriorityOrder& order, Random& random,
                                 const StopCondition& stop, ProgressReport& progress,
                                 const OnStop& on_stop = nullptr);

/// Plans all robots of `order` from the beginning, with repairs only; for further attempts.
OrderingResult repair_once(PlanState& state, const PriorityOrder& order, Random& random,
                           const StopCondition& stop, ProgressReport& progress);

}  // namespace fleetplan::core
