#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/model/plan.h"
#include "core/prioritized/plan_state.h"
#include "core/prioritized/priority_order.h"
#include "core/prioritized/progress_report.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// How planning all robots went. The trajectories are in the PlanState; robots without one stand at their
/// starts for ever (unless time was up before the first was planned).
struct PrioritizedResult {
  std::vector<Unplanned> unplanned;  // ascending
  std::int64_t attempts = 0;
  bool cut_off = false;  // the clock decided something
};

/// Prioritized planning of `movers` (ascending): one after the other in the order of their priorities, each
/// among the trajectories of those before it; after a failure again with other priorities, as the options'
/// reordering says (paper, section Prioritized planning). Until `patience` is met it tries to plan them all;
/// from then until `stop` is met it makes what it has into a safe partial plan of as many as possible.
PrioritizedResult plan_prioritized(PlanState& state, const std::vector<std::size_t>& movers, Random& random,
                                   const StopCondition& patience, const StopCondition& stop,
                                   ProgressReport& progress);

}  // namespace fleetplan::core
