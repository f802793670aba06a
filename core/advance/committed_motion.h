#pragma once

// Where commitments have to end, so that nobody drives into a robot that stands.

#include <vector>

#include "core/advance/moment.h"
#include "core/model/action.h"
#include "core/model/robot.h"
#include "core/model/surroundings.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// What commitments are judged by, on the clock of the moment.
struct Motions {
  std::vector<std::vector<Action>> braking;       // by robot, see braking_of
  std::vector<std::vector<Action>> courses = {};  // by robot: all that it does if it goes on as planned
  std::vector<MovingObstacle> obstacles = {};
};

/// Returns by robot what it keeps around its disk while it is committed: its vicinity and the inflation,
/// metres. Inflation is there for robots that are not where their plans have them, so it is used up by as
/// much as they are elsewhere at the moment, up to a half. What is released cannot be shortened for the sake
/// of a margin: then there is none.
std::vector<double> margins_of(const std::vector<Robot>& robots, const std::vector<Execution>& executions,
                               const Moment& moment, const std::vector<Robot>& next, Work& work);

/// Ends committed actions early, so that every robot may stay for ever where its commitment ends: none meets
/// another one, nor passes where another one has ended. Whatever becomes of the plans behind the commitments,
/// nobody then drives into a robot that stands. Robots are only stopped while they drive; a wait stays
/// committed. `margins`: metres, by robot, that they keep around their disks; robots that are nearer to each
/// other at the moment keep half of what they have, or a quarter of the margins if they have that.
/// None of these commitments ends before the braking of its robot, unless it collides with another
/// commitment. Where two robots meet that cannot stop in time, although they would not if they went on as
/// planned, they are committed to that as far as it takes, which is their braking from then on. First,
/// a commitment that leads into an obstacle ends where the robot can stop at last without touching any until
/// it stands, or else as soon as it can. Ends early when `work` is met.
void clear_commitments(std::vector<Robot>& robots, const std::vector<double>& margins, Motions& motions,
                       Work& work);

}  // namespace fleetplan::core
