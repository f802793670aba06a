#pragma once

#include "core/moves/lacam.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// Whether two robots would have to pass each other on a line of vertices without branches. Robots on such a
/// line keep their order, so there is then no plan in steps. False if `stop` is met first.
bool have_to_pass_on_a_line(const StepProblem& problem, const StopCondition& stop);

}  // namespace fleetplan::core
