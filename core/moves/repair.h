#pragma once

// Planning in one priority order, with repairs after failures.

#include <cstdint>
#include <functional>
#include <optional>

#include "core/fleet/plan_state.h"
#include "core/fleet/progress_report.h"
#include "core/moves/fleet_steps.h"
#include "core/moves/orderings.h"
#include "core/runtime/random.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// Who decides whether repairs go on.
struct RepairPace {
  /// Asked when the stop condition is met. Without it, repairs end then.
  OnStop on_stop;
  /// Asked before each robot: whether to ask `on_stop` although the stop condition is not met. Optional.
  std::function<bool()> is_due;
};

/// Plans all robots of `order`, which have no reservations. After a failure it repairs the plan instead of
/// starting again. A robot that fails among all others is planned so that it conflicts with few others
/// (EjectionSearch), and those are planned next. `unsolved` is empty unless `stop` was met or `pace` decided
/// not to go on.
///
/// A robot that fails too often may be in a cycle of ejections. It is then treated as follows:
///
/// 1. It is planned only among the robots of higher priority.
/// 2. If that fails, it gets the highest priority (paper, section Prioritized planning). With a start delay,
///    it is planned among the robots that had a higher priority and are at least as large. Or it is planned
///    only among the robots that stay at their starts.
/// 3. The trajectories that conflict with its own are removed, and the priorities of their robots are
///    shuffled.
/// 4. If it finds no path, or fails too often in this way as well, it is given up: it stays at its start.
///
/// Before all this, robots that yield (Robot::yields) may make way. A robot is planned past them, as if they
/// left after their own goals, in three cases. It fails, it gains nothing within the horizon, or it costs
/// much more than alone. If it gains more than they lose, the yielding robots in its way are planned again.
/// So no robot moves for nothing. A robot that cannot make way stays.
///
/// If failures may have no end, all robots are planned in `steps`.
OrderingResult repair_all(PlanState& state, const PriorityOrder& order, FleetSteps& steps, Random& random,
                          const StopCondition& stop, ProgressReport& progress, const RepairPace& pace = {});

/// Plans as repair_all() does. Returns none as soon as this many attempts have failed.
std::optional<OrderingResult> repair_unless(std::int64_t max_failures, PlanState& state,
                                            const PriorityOrder& order, FleetSteps& steps, Random& random,
                                            const StopCondition& stop, ProgressReport& progress,
                                            const RepairPace& pace);

/// Plans the robots of `order` as repair_all() does, but some of them already follow trajectories. They keep
/// these until a robot with a higher priority needs their way. Robots are not planned in steps.
OrderingResult repair_around(PlanState& state, const PriorityOrder& order, Random& random,
                             const StopCondition& stop, ProgressReport& progress,
                             const RepairPace& pace = {});

}  // namespace fleetplan::core
