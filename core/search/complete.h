#pragma once

#include <cstddef>
#include <vector>

#include "core/model/plan.h"
#include "core/search/fleet_state.h"
#include "core/search/priority_order.h"
#include "core/search/stop_condition.h"

namespace fleetplan::core {

struct Completion {
  std::vector<Unplanned> unplanned;  // ascending
  bool cut_off = false;
};

/// Makes a safe partial plan: plans each robot of `order` that has no trajectory yet, once. One that finds no
/// way is given up and stands at its start for ever; those whose trajectories cross it there are planned
/// again, and given up as well if that fails, until nothing changes. `hopeless` robots stand already. Once
/// `stop` is met, nothing is searched any more.
Completion complete(FleetState& state, const PriorityOrder& order, const std::vector<std::size_t>& hopeless,
                    const StopCondition& stop);

}  // namespace fleetplan::core
