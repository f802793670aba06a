#pragma once

// Planning in one priority order, with repairs after failures.

#include <cstdint>
#include <optional>

#include "core/fleet/plan_state.h"
#include "core/fleet/progress_report.h"
#include "core/moves/fleet_steps.h"
#include "core/moves/orderings.h"
#include "core/runtime/random.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// Plans all robots of `order`, which have no reservations, and repairs the plan after a failure instead of
/// starting again: a robot that fails among all others is planned so that it conflicts with few others
/// (EjectionSearch), and those are planned next. `unsolved` is empty unless `stop` was met. When it is,
/// `on_stop` decides, if there is one, whether to go on.
///
/// A robot that fails too often for that may be in a cycle. It is planned among those of higher priority
/// only. If that fails, it gets the highest priority (paper, section Prioritized planning), and is planned
/// among the robots that had a higher one and are at least as large, after a start delay, or among only those
/// that stay at their starts. The trajectories that conflict with its own are removed, and the priorities of
/// their robots are shuffled. One that finds no path then, or fails too often for that as well, is given up:
/// it stays at its start.
///
/// Before that, a robot that fails, gains nothing within the horizon, or costs much more than alone is
/// planned past those that yield (Robot::yields), as if they left when they have served their goals; if it
/// gains more by that than they lose, those that are in its way are planned again. So nobody moves for
/// nothing. One that cannot make way stays.
///
/// If failures may have no end, all robots are planned in `steps`.
OrderingResult repair_all(PlanState& state, const PriorityOrder& order, FleetSteps& steps, Random& random,
                          const StopCondition& stop, ProgressReport& progress,
                          const OnStop& on_stop = nullptr);

/// Plans as repair_all() does. Returns none as soon as so many attempts have failed.
std::optional<OrderingResult> repair_unless(std::int64_t max_failures, PlanState& state,
                                            const PriorityOrder& order, FleetSteps& steps, Random& random,
                                            const StopCondition& stop, ProgressReport& progress,
                                            const OnStop& on_stop);

/// Plans the robots of `order` as repair_all() does, from a state in which some of them follow trajectories
/// already. They keep these until a robot with a higher priority needs their way, and are not planned in
/// steps.
OrderingResult repair_around(PlanState& state, const PriorityOrder& order, Random& random,
                             const StopCondition& stop, ProgressReport& progress,
                             const OnStop& on_stop = nullptr);

}  // namespace fleetplan::core
