#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/model/plan.h"
#include "core/search/fleet_state.h"
#include "core/search/priority_order.h"
#include "core/search/stop_condition.h"

namespace fleetplan::core {

/// How planning all robots went. The trajectories are in the FleetState; robots without one stand at their
/// starts for ever.
struct PrioritizedResult {
  std::vector<Unplanned> unplanned;  // ascending
  std::int64_t attempts = 0;
  bool cut_off = false;  // the clock decided something
};

/// Prioritized planning of `movers` (ascending): one after the other in the order of their priorities, each
/// among the trajectories of those before it; after a failure again in another order (paper, section
/// Prioritized planning), until `attempts_stop` is met. What could not be solved in full is then completed as
/// far as possible, until `stop` is met.
PrioritizedResult plan_prioritized(FleetState& state, const std::vector<std::size_t>& movers, Random& random,
                                   const StopCondition& attempts_stop, const StopCondition& stop);

}  // namespace fleetplan::core
