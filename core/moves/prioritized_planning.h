#pragma once

// Prioritized planning of all robots, from the beginning.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/fleet/plan_state.h"
#include "core/fleet/progress_report.h"
#include "core/model/plan.h"
#include "core/runtime/random.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// The outcome of planning all robots. The trajectories are in the PlanState; robots without one stay at
/// their starts (unless `stop` was met before the first was planned).
struct PrioritizedResult {
  std::vector<Unplanned> unplanned;  // ascending
  std::int64_t attempts = 0;
  bool cut_off = false;  // the stop condition decided something
  /// With a horizon: a robot that would come and go for ever, as it and others cannot all arrive, however far
  /// they go.
  struct Shuttling {
    std::size_t robot = 0;
    std::vector<std::size_t> others;  // ascending
  };
  std::optional<Shuttling> shuttling;
  /// The last plan in steps failed for the size that its search may have: it proves nothing.
  bool is_limited = false;
};

/// The use of a time budget.
struct PlanningTime {
  StopCondition first_part;  // when it is met, a safe partial plan is made and kept
  StopCondition keeping;     // ends the making of that plan
  StopCondition all;

  /// Divides the time that remains until `stop` is met.
  static PlanningTime until(const StopCondition& stop);
};

/// Prioritized planning of `movers` (ascending): one by one in the order of their priorities, each among the
/// trajectories of those before it; after a failure again with other priorities, by the option `reordering`
/// (paper, section Prioritized planning). If that plans not all of them, plans them in steps
/// (lattice_steps.h) or, few of them, so that two make room for each other (making_room.h). If robots are
/// given up all the same, starts again in random orders until all are planned, the time is over, or nothing
/// is left to try: when each unplanned robot has no path even if the others are absent, when the option
/// forbids it, or with few robots when all orders have failed. Without a deadline the number of orders is
/// limited. Leaves the best safe plan in the state.
PrioritizedResult plan_prioritized(PlanState& state, const std::vector<std::size_t>& movers, Random& random,
                                   const PlanningTime& time, ProgressReport& progress);

}  // namespace fleetplan::core
