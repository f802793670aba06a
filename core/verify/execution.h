#pragma once

// What a robot does when it is told a plan, whatever the plan: where it is at every moment from 0 on.

#include <vector>

#include "core/model/plan.h"
#include "core/model/robot.h"

namespace fleetplan::core {

/// A stretch of time in which a robot's centre moves straight at constant speed, or stands. Map frame,
/// metres, seconds.
struct Leg {
  double t_begin = 0.0;
  double t_end = 0.0;  // infinity for the final rest; t_begin for a leg that takes no time
  Position from{0.0, 0.0};
  Position to{0.0, 0.0};
};

/// Where the centre is at `t`: exactly `from` up to t_begin, exactly `to` from t_end on.
Position position_at(const Leg& leg, double t);

/// The legs of a robot from t = 0 to infinity, in order, each beginning when the one before ends. Without a
/// plan (null), or with one of no actions, the robot stands at its start for ever; otherwise it rests where
/// its last action ends. Plans that break the rules are made sense of: it stands where it is while there is
/// nothing to do, an action that begins before the one before has ended (or before 0) loses that part, and
/// one that ends before it begins takes no time. Every number of the plan is finite.
std::vector<Leg> execute(const Robot& robot, const RobotPlan* plan);

}  // namespace fleetplan::core
