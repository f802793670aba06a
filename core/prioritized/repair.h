#pragma once

#include <cstdint>
#include <optional>

#include "core/prioritized/ordering_result.h"
#include "core/prioritized/plan_state.h"
#include "core/prioritized/priority_order.h"
#include "core/prioritized/progress_report.h"
#include "core/runtime/random.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// Plans all robots of `order` and raises the priority of those that fail (paper, section Prioritized
/// planning), but repairs the plan instead of starting again:
///
/// 1. A robot that fails among all others is planned among those of higher priority only.
/// 2. If that fails, it gets the highest priority. It is planned among the robots that had a higher priority
///    and are at least as large, and if that fails, among only those that stay at their starts.
/// 3. The trajectories that conflict with its own are removed, and their robots are planned again.
///
/// After several failures the fleet counts as a dense crowd: then a failed robot is not raised, but planned
/// so that it conflicts with few others (EjectionSearch), and those are planned next.
///
/// If robots raise each other again and again, the priorities of those involved are shuffled, and a start
/// delay is tried. A robot that fails at step 2, or too often, is given up: it stays at its start. Returns
/// none as soon as `max_failures` attempts have failed. When `stop` is met, `on_stop` decides, if there is
/// one, whether to go on.
std::optional<OrderingResult> repair(PlanState& state, const PriorityOrder& order, std::int64_t max_failures,
                                     Random& random, const StopCondition& stop, ProgressReport& progress,
                                     const OnStop& on_stop = nullptr);

/// The same from a state in which some robots of `order` follow trajectories already: they do so until a
/// robot with a higher priority needs their way.
OrderingResult repair_around(PlanState& state, const PriorityOrder& order, Random& random,
                             const StopCondition& stop, ProgressReport& progress,
                             const OnStop& on_stop = nullptr);

}  // namespace fleetplan::core
