#pragma once

#include "core/geometry/position.h"
#include "core/instance.h"
#include "core/model/robot.h"

namespace fleetplan::core {

/// From a pose to the goal with nothing in the way, seconds: the straight line, the rotation into its
/// direction and from there to the goal heading. The added wait is left out.
///
/// Why no detour turns less: the headings of a path sweep an arc. If the arc contains the straight direction,
/// it has been turned to on the way. If not, the displacement is a positive combination of headings at angles
/// a and b on either side of it with a + b < pi, and the arc joins them the back way, over 2 pi - a - b > a +
/// b.
double straight_cost(const Pose& from, const Goal& goal, const Motion& motion);

/// No plan for this robot (it has a goal) can cost less, seconds, walls left out: the straight cost and the
/// added wait. Exact where the goal is in sight; elsewhere TautBounds knows better.
double lower_bound(const Robot& robot, const Motion& motion);

}  // namespace fleetplan::core
