#pragma once

#include <vector>

#include "core/verify/execution.h"

namespace fleetplan::core {

/// Boundaries that cut the time of all legs into windows in which each robot has about half a leg: ascending,
/// the first 0, the last the moment from which everybody rests for ever. Only 0 if nobody ever moves.
std::vector<double> time_windows(const std::vector<std::vector<Leg>>& legs_by_robot);

}  // namespace fleetplan::core
