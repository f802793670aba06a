#pragma once

#include <cstddef>
#include <vector>

#include "core/verify/execution/execution.h"
#include "core/verify/geometry/obstacle_field.h"
#include "core/verify/verify.h"
#include "core/verify/violation_list.h"

namespace fleetplan::core {

/// Reports where a disk overlaps obstacles by more than the tolerance: one violation for each leg, or one for
/// consecutive legs through which the overlap continues. `legs` are a result of `execute`. Ends early when
/// `stop` is met.
ViolationList check_obstacles(const ObstacleField& field, std::size_t robot, double radius,
                              const std::vector<Leg>& legs, double tolerance, const StopCondition& stop);

}  // namespace fleetplan::core
