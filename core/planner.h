#pragma once

#include "core/model/plan.h"
#include "core/model/plan_options.h"
#include "core/model/problem.h"
#include "core/runtime/executor.h"
#include "core/runtime/progress.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// Plans collision-free timed motions for all robots of the problem (paper, Method), or for as many as it can
/// until the stop condition is met. The same problem, options and build give the same plan unless
/// `deterministic` is false; the executor's threads make `anytime` faster and change nothing else, and
/// neither does the observer, if there is one.
Plan plan(const Problem& problem, const PlanOptions& options, const StopCondition& stop, Executor& executor,
          Observer* observer = nullptr);

/// In the caller's thread, and nobody watches.
Plan plan(const Problem& problem, const PlanOptions& options, const StopCondition& stop);

}  // namespace fleetplan::core
