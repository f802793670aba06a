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

/// The outcome of planning all robots. The trajectories are in the PlanState; robots without one stay at
/// their starts (unless `stop` was met before the first was planned).
struct PrioritizedResult {
  std::vector<Unplanned> unplanned;  // ascending
  std::int64_t attempts = 0;
  bool cut_off = false;  // the stop condition decided something
};

/// Prioritized planning of `movers` (ascending): one by one in the order of their priorities, each among the
/// trajectories of those before it; after a failure again with other priorities, by the option `reordering`
/// (paper, section Prioritized planning). Until `stop_attempts` is met it tries to plan all robots. If that
/// fails, it makes a safe partial plan of as many as possible until `stop` is met.
PrioritizedResult plan_prioritized(PlanState& state, const std::vector<std::size_t>& movers, Random& random,
                                   const StopCondition& stop_attempts, const StopCondition& stop,
                                   ProgressReport& progress);

}  // namespace fleetplan::core
