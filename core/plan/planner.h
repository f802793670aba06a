#pragma once

#include "core/model/plan.h"
#include "core/model/plan_options.h"
#include "core/model/problem.h"
#include "core/model/progress.h"
#include "core/plan/part_timer.h"
#include "core/runtime/executor.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// The detail of a robot that has no plan because the memory was not enough (see MemoryAccount).
inline constexpr const char* kMemorySpent =
    "The memory for one plan (--max-plan-memory) was spent before a way was found: send fewer robots or a "
    "map "
    "with fewer cells, or raise that limit.";

/// Plans collision-free timed motions for all robots of the problem (paper, Method), or for as many as
/// possible until the stop condition is met:
///
/// 0. Keeps previous plans that hold, and plans the robots without them around these.
/// 1. Triage: finds the robots that cannot move whatever the others do.
/// 2. Prioritized planning: a first plan, or a safe partial plan. Moves of robots that make way
///    (Robot::yields) are undone if no other robot needs them. New paths are smoothed.
/// 3. Unavoidable collisions: finds collisions with committed motion and obstacles that no plan prevents.
/// 4. Lower bounds of the cost of each robot alone on the map.
/// 5. Large neighbourhood search, in mode `anytime`: improves the plan until the stop condition is met. Then
///    unnecessary moves are undone again.
/// 6. Collects the trajectories as actions.
///
/// Plans depend only on the problem, the options and the build, unless `deterministic` is false. The
/// executor's threads make `anytime` faster. They do not change the plan. Neither do the observer and the
/// timer, which may be null. The timer is told when `bounds` and `improve` begin.
Plan plan(const Problem& problem, const PlanOptions& options, const StopCondition& stop, Executor& executor,
          Observer* observer = nullptr, PartTimer* timer = nullptr);

/// Plans in the caller's thread, without an observer.
Plan plan(const Problem& problem, const PlanOptions& options, const StopCondition& stop);

}  // namespace fleetplan::core
