#include "core/bounds/lower_bound.h"

#include <cmath>

#include "core/geometry/tolerance.h"

namespace fleetplan::core {

double straight_cost(const Pose& from, const Goal& goal, const Motion& motion) {
  const Position d = goal.position - from.position;
  const double distance = d.norm();
  if (distance <= kSamePosition) return goal.theta ? motion.rotation_time(from.theta, *goal.theta) : 0.0;
  const double heading = std::atan2(d.y(), d.x());
  const double last = goal.theta ? motion.rotation_time(heading, *goal.theta) : 0.0;
  return motion.rotation_time(from.theta, heading) + motion.translation_time(distance) + last;
}

double lower_bound(const Robot& robot, const Motion& motion) {
  const Pose from = robot.committed_end();
  const bool stays = (robot.goal->position - from.position).norm() <= kSamePosition;
  return robot.committed_until() + straight_cost(from, *robot.goal, motion) +
         (stays ? 0.0 : motion.wait_before_move);
}

}  // namespace fleetplan::core
