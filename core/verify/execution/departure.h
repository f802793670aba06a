#pragma once

#include <limits>

#include "core/model/plan.h"
#include "core/model/robot.h"

namespace fleetplan::core {

/// When the motion of a robot becomes the planner's own. Seconds.
struct Departure {
  double committed_until = 0.0;  // its commitment ends
  /// It begins, and ends, its first translation after the commitment; infinity if there is none.
  double leaves = std::numeric_limits<double>::infinity();
  double first_move_ends = std::numeric_limits<double>::infinity();

  /// Whether all of [t_begin, t_end] belongs to the commitment, or to what follows the stay at its end.
  bool commits(double t_end) const { return t_end <= committed_until; }
  bool plans(double t_begin) const { return t_begin >= leaves; }
};

/// `plan` is null for a robot without a plan. Every number is finite.
Departure departure_of(const Robot& robot, const RobotPlan* plan);

}  // namespace fleetplan::core
