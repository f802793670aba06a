#pragma once

#include "core/prioritized/ordering_result.h"
#include "core/prioritized/plan_state.h"
#include "core/prioritized/priority_order.h"
#include "core/prioritized/progress_report.h"
#include "core/runtime/random.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// Plans all robots of `order`; whenever one fails, starts again in another order (paper, section Prioritized
/// planning). Ends when all have a trajectory, all orders have failed, or `stop` is met, and leaves the state
/// of the attempt that planned the most robots. If all orders fail, tries some random ones in which the first
/// robot starts late. When `stop` is met, `on_stop` decides, if there is one, whether to go on.
OrderingResult plan_with_restarts(PlanState& state, PriorityOrder order, Random& random,
                                  const StopCondition& stop, ProgressReport& progress,
                                  const OnStop& on_stop = nullptr);

}  // namespace fleetplan::core
