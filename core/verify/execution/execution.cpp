#include "core/verify/execution/execution.h"

#include <algorithm>
#include <limits>

namespace fleetplan::core {

Position position_at(const Leg& leg, double t) {
  if (t <= leg.t_begin) return leg.from;
  if (t >= leg.t_end) return leg.to;
  const double fraction = (t - leg.t_begin) / (leg.t_end - leg.t_begin);
  return leg.from + fraction * (leg.to - leg.from);
}

std::vector<Leg> execute(const Robot& robot, const RobotPlan* plan) {
  std::vector<Leg> legs;
  double now = 0.0;
  Position here = robot.start.position;
  const std::vector<Action> none;
  const std::vector<Action>& without_plan = robot.invalid ? none : robot.committed;
  const std::vector<Action>& actions = plan != nullptr ? plan->actions : without_plan;
  legs.reserve(actions.size() + 1);
  for (const Action& action : actions) {
    if (action.t_start > now) {
      legs.push_back({now, action.t_start, here, here});
      now = action.t_start;
    }
    const Leg planned{action.t_start, std::max(action.t_start, action.t_end), action.from.position,
                      action.to.position};
    // An action that is entirely in the past, or without duration, takes place at once.
    const Position from = planned.t_end > now ? position_at(planned, now) : planned.from;
    const double until = std::max(now, planned.t_end);
    legs.push_back({now, until, from, planned.to});
    now = until;
    here = planned.to;
  }
  legs.push_back({now, std::numeric_limits<double>::infinity(), here, here});
  return legs;
}

std::vector<Leg> legs_of(const MovingObstacle& obstacle) {
  std::vector<Leg> legs;
  legs.reserve(obstacle.motion.size());
  for (std::size_t k = 0; k + 1 < obstacle.motion.size(); ++k) {
    const MovingObstacle::Entry& from = obstacle.motion[k];
    const MovingObstacle::Entry& to = obstacle.motion[k + 1];
    legs.push_back({from.t, to.t, from.position, to.position});
  }
  if (obstacle.motion.empty()) return legs;
  const MovingObstacle::Entry& last = obstacle.motion.back();
  if (obstacle.after == MovingObstacle::After::stays) {
    legs.push_back({last.t, std::numeric_limits<double>::infinity(), last.position, last.position});
  } else if (legs.empty()) {
    legs.push_back({last.t, last.t, last.position, last.position});
  }
  return legs;
}

}  // namespace fleetplan::core
