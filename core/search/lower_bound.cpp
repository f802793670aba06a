#include "core/search/lower_bound.h"

#include <cmath>

#include "core/geometry/tolerance.h"

namespace fleetplan::core {

double lower_bound(const Robot& robot, const Motion& motion) {
  const Goal& goal = *robot.goal;
  const Position d = goal.position - robot.start.position;
  const double distance = d.norm();
  if (distance <= kContactTolerance)
    return goal.theta ? motion.rotation_time(robot.start.theta, *goal.theta) : 0.0;
  const double heading = std::atan2(d.y(), d.x());
  const double last = goal.theta ? motion.rotation_time(heading, *goal.theta) : 0.0;
  return motion.rotation_time(robot.start.theta, heading) + motion.wait_before_move +
         motion.translation_time(distance) + last;
}

}  // namespace fleetplan::core
