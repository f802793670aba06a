#pragma once

#include "core/geometry/position.h"
#include "core/instance.h"
#include "core/model/robot.h"

namespace fleetplan::core {

/// The cost from a pose to the goal without obstacles, seconds: the straight line, the rotation into its
/// direction and from there to the goal heading. The wait before moves is not included. No path costs less;
/// docs/method.md, Lemma 1, proves it.
double straight_cost(const Pose& from, const Goal& goal, const Motion& motion);

/// A lower bound of the cost of a robot with a goal, seconds, obstacles ignored: the straight cost and one
/// wait before a move. Exact where the goal is in sight; elsewhere TautPathBounds is tighter.
double lower_bound(const Robot& robot, const Motion& motion);

}  // namespace fleetplan::core
