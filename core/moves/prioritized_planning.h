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

/// The outcome of planning all robots. The trajectories are in the PlanState. Robots without a trajectory
/// stay at their starts, unless `stop` was met before the first robot was planned.
struct PrioritizedResult {
  std::vector<Unplanned> unplanned;  // ascending
  std::int64_t attempts = 0;
  bool cut_off = false;  // the stop condition decided something
  /// With a horizon: a robot that would come and go for ever, because it and others cannot all arrive,
  /// however far they go.
  struct Shuttling {
    std::size_t robot = 0;
    std::vector<std::size_t> others;  // ascending
  };
  std::optional<Shuttling> shuttling;
  /// The last plan in steps failed because the search reached its size limit. So it proves nothing.
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

/// Prioritized planning of `movers` (ascending): one robot after the other in the order of their priorities,
/// each among the trajectories of the robots before it.
///
/// 1. After a failure, plans again with other priorities, by the option `reordering` (paper, section
///    Prioritized planning).
/// 2. If robots are left, plans all in steps (lattice_steps.h). If only a few robots are left, two robots
///    make room for each other (making_room.h).
/// 3. If robots are still given up, starts again in random orders. This ends when all robots are planned, the
///    time is over, or nothing is left to try.
///
/// Nothing is left to try if one of these holds:
///
/// - No unplanned robot has a path even if the others are absent.
/// - The option forbids it.
/// - There are few robots, and all orders have failed.
///
/// Without a deadline, the number of orders is limited. Leaves the best safe plan in the state.
PrioritizedResult plan_prioritized(PlanState& state, const std::vector<std::size_t>& movers, Random& random,
                                   const PlanningTime& time, ProgressReport& progress);

}  // namespace fleetplan::core
