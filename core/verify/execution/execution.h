#pragma once

// How a robot executes a plan, valid or not: where it is at every time from 0 on. How an obstacle moves.

#include <vector>

#include "core/model/moving_obstacle.h"
#include "core/model/plan.h"
#include "core/model/robot.h"

namespace fleetplan::core {

/// A time interval in which a robot's centre moves straight at constant speed, or stands. Map frame, metres,
/// seconds.
struct Leg {
  double t_begin = 0.0;
  double t_end = 0.0;  // infinity for the final rest; t_begin for a leg that takes no time
  Position from{0.0, 0.0};
  Position to{0.0, 0.0};
};

/// The position of the centre at `t`: exactly `from` up to t_begin, exactly `to` from t_end on.
Position position_at(const Leg& leg, double t);

/// The legs of a robot from t = 0 to infinity, in order, each beginning when the previous one ends. Without a
/// plan (null) the robot executes its committed actions, unless it is invalid. Without actions it stays at
/// its start; otherwise it rests where its last action ends. Invalid plans are executed as follows: in a gap
/// between actions the robot stands; of an action that begins before the previous one has ended (or before
/// 0), the overlapping part is omitted; an action that ends before it begins takes no time. Every number of
/// the plan (and of the committed actions) is finite.
std::vector<Leg> execute(const Robot& robot, const RobotPlan* plan);

/// The legs of an obstacle from when it appears until it vanishes, or to infinity. One that appears for an
/// instant only has a leg that takes no time.
std::vector<Leg> legs_of(const MovingObstacle& obstacle);

}  // namespace fleetplan::core
