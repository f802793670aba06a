#pragma once

#include <cstddef>

#include "core/model/plan.h"
#include "core/prioritized/plan_state.h"

namespace fleetplan::core {

/// The reason of a robot of this radius (metres, inflation included) that has no way to its goal.
Unplanned unplanned_without_way(std::size_t robot, double radius, const Way& way);

}  // namespace fleetplan::core
