#pragma once

#include <optional>
#include <vector>

#include "core/moves/configuration_search.h"
#include "core/moves/joint_steps.h"
#include "core/runtime/random.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// Plans robots in steps by LaCAM (see ConfigurationSearch), with PIBT (Okumura et al., Artificial
/// Intelligence, 2022) for disks. A robot on its way pushes away all robots that it would touch.
///
/// Returns the configurations from the starts to the goals. In each step, robots can move one after the
/// other, while all others rest where they are or have already arrived. None if there is no such plan, if
/// `stop` is met first, or if the search takes too much memory in several tries.
std::optional<std::vector<Configuration>> plan_by_pushing(const JointSteps& steps, Random& random,
                                                          const StopCondition& stop);

}  // namespace fleetplan::core
