#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/prioritized/plan_state.h"
#include "core/prioritized/priority_order.h"
#include "core/prioritized/progress_report.h"
#include "core/runtime/random.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// How restarts ended. The state is that of the attempt that got farthest; robots of `unsolved` have no
/// trajectory.
struct RestartsResult {
  std::vector<std::size_t> given_up;  // found no way among those that stay, and stand for ever now
  std::vector<std::size_t> unsolved;  // by priority
  std::int64_t attempts = 0;
  bool cut_off = false;  // false with robots unsolved: no order is left to try, and holding the first robot
                         // back did not help
};

/// Plans all robots of `order`, and from the start again in another order whenever one finds no way, until
/// all have a trajectory, all orders have failed, or `stop` is met.
RestartsResult plan_with_restarts(PlanState& state, PriorityOrder order, Random& random,
                                  const StopCondition& stop, ProgressReport& progress);

}  // namespace fleetplan::core
