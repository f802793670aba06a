#pragma once

#include <cstddef>
#include <vector>

#include "core/verify/execution.h"
#include "core/verify/obstacle_field.h"
#include "core/verify/verify.h"

namespace fleetplan::core {

/// Where a disk overlaps what is blocked by more than the tolerance: one violation a leg, and one for all
/// legs through which the overlap goes on. `legs` as `execute` makes them.
std::vector<Violation> check_obstacles(const ObstacleField& field, std::size_t robot, double radius,
                                       const std::vector<Leg>& legs, double tolerance);

}  // namespace fleetplan::core
