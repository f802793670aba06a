#pragma once

#include <vector>

#include "core/verify/execution/execution.h"

namespace fleetplan::core {

/// The boundaries of time windows in which each robot has about half a leg: ascending, the first is 0, the
/// last the time at which all robots have come to rest. Only 0 if no robot ever moves. The same for `others`,
/// which move among them.
std::vector<double> time_windows(const std::vector<std::vector<Leg>>& legs_by_robot,
                                 const std::vector<std::vector<Leg>>& others = {});

}  // namespace fleetplan::core
