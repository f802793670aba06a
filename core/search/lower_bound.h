#pragma once

#include "core/model/robot.h"
#include "core/search/fleet.h"

namespace fleetplan::core {

/// No plan for this robot (it has a goal) can cost less, seconds: the straight line, the rotation into its
/// direction and from there to the goal heading, and the added wait; exact where the goal is in sight.
///
/// Why no detour turns less: the headings of a path sweep an arc. If the arc contains the straight direction,
/// it has been turned to on the way. If not, the displacement is a positive combination of headings at angles
/// a and b on either side of it with a + b < pi, and the arc joins them the back way, over 2 pi - a - b > a +
/// b.
double lower_bound(const Robot& robot, const Motion& motion);

}  // namespace fleetplan::core
