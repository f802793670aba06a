#pragma once

// Where commitments have to end, so that no robot drives into a robot that stands.

#include <vector>

#include "core/advance/moment.h"
#include "core/model/action.h"
#include "core/model/robot.h"
#include "core/model/surroundings.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// The facts by which commitments are judged, on the clock of the moment.
struct Motions {
  std::vector<std::vector<Action>> braking;       // by robot, see braking_of
  std::vector<std::vector<Action>> courses = {};  // by robot: all that it does if it goes on as planned
  std::vector<MovingObstacle> obstacles = {};
};

/// Returns, by robot, the margin that it keeps around its disk while it is committed, metres: its vicinity
/// and the inflation. Inflation absorbs position errors: a robot that is d metres off its plan keeps
/// `inflation - d`, but at least half of `inflation`. Margins are 0 if robots have reported what is released,
/// because that cannot be shortened for a margin.
std::vector<double> margins_of(const std::vector<Robot>& robots, const std::vector<Execution>& executions,
                               const Moment& moment, const std::vector<Robot>& next, Work& work);

/// Ends committed actions early, so that every robot may stay for ever where its commitment ends. No robot
/// meets another, or passes a place where another robot stays. So no robot drives into a robot that stands,
/// whatever happens to the plans after the commitments. Robots are stopped only while they drive; a wait
/// stays committed.
///
/// 1. If a commitment leads into an obstacle, it ends at the last time at which the robot can stop safely.
///    Safely means that no obstacle touches it until it stands. If there is no such time, it ends as soon as
///    the robot can stop.
/// 2. No commitment ends before the braking of its robot, unless it collides with another commitment.
/// 3. Two robots may meet that cannot stop in time, although they would not meet if they went on as planned.
///    They are committed to the plan as far as needed. This is their braking from then on.
///
/// `margins`: metres, by robot, around their disks. Robots may be nearer to each other at the moment. They
/// keep half of their present distance, or a quarter of the margins if they have that. Ends early when `work`
/// is met.
void clear_commitments(std::vector<Robot>& robots, const std::vector<double>& margins, Motions& motions,
                       Work& work);

}  // namespace fleetplan::core
