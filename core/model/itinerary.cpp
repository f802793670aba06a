#include "core/model/itinerary.h"

#include <algorithm>
#include <utility>

#include "core/geometry/position.h"
#include "core/geometry/segment.h"
#include "core/geometry/tolerance.h"

namespace fleetplan::core {

bool is_in_pose(const Pose& pose, const Goal& goal) {
  if (goal.anywhere) return true;
  return (pose.position - goal.position).norm() <= kContactTolerance &&
         (!goal.theta || angle_between(pose.theta, *goal.theta) <= kContactTolerance);
}

bool has_arrived(const Robot& robot) {
  return robot.via.empty() && robot.goal->service == 0.0 && is_in_pose(robot.committed_end(), *robot.goal);
}

GoalsOnTheWay::GoalsOnTheWay(const Robot& robot) : robot_(robot) { rest(robot.start); }

void GoalsOnTheWay::execute(const Action& action) {
  if (action.type != Action::Type::wait) arrived_ = action.t_end;
  now_ = action.t_end;
  rest(action.to);
}

/// Serves the goals in this pose, in which the robot is at rest from `arrived_` to `now_`.
void GoalsOnTheWay::rest(const Pose& pose) {
  service_done_ = 0.0;
  for (; count() < robot_.goal_count() && is_in_pose(pose, robot_.goal_at(count()));) {
    const Goal& goal = robot_.goal_at(count());
    const double begin = std::max(arrived_, goal.not_before);
    service_done_ = std::clamp(now_ - begin, 0.0, goal.service);
    if (count() + 1 == robot_.goal_count() || begin + goal.service > now_ + kSameTime) return;
    visits_.push_back({count(), arrived_, begin + goal.service});
    arrived_ = begin + goal.service;
    service_done_ = 0.0;
  }
}

ServedGoals served_goals(const Robot& robot, std::span<const Action> actions) {
  GoalsOnTheWay on_the_way(robot);
  for (const Action& action : actions) on_the_way.execute(action);
  ServedGoals served{on_the_way.visits()};
  const Pose pose = actions.empty() ? robot.start : actions.back().to;
  if (robot.goal && is_in_pose(pose, robot.goal_at(on_the_way.count()))) {
    served.in_next_pose = true;
    served.arrived = on_the_way.arrived();
    served.service_done = on_the_way.service_done();
  }
  return served;
}

std::vector<Visit> visits_of(const Robot& robot, std::span<const Action> actions) {
  ServedGoals served = served_goals(robot, actions);
  const std::size_t last = robot.goal_count() - 1;
  if (robot.goal && served.in_next_pose && served.visits.size() == last) {
    served.visits.push_back({last, served.arrived, kForever});
  }
  return std::move(served.visits);
}

namespace {

Trajectory committed_trajectory(const Robot& robot) {
  Trajectory trajectory;
  trajectory.start = robot.start.position;
  for (const Action& action : robot.committed) {
    if (action.type != Action::Type::translate || action.from.position == action.to.position) continue;
    const Segment path{action.from.position, action.to.position};
    trajectory.moves.push_back({{path, action.t_start, action.t_end}, action.profile, action.reverse});
  }
  trajectory.cost = robot.committed_until();
  return trajectory;
}

}  // namespace

const std::vector<Action>& previous_actions(const Robot& robot) {
  return robot.goal && robot.previous && !robot.previous->empty() ? *robot.previous : robot.committed;
}

double last_service_end(const Robot& robot, std::span<const Action> actions) {
  const std::vector<Visit> visits = visits_of(robot, actions);
  if (visits.size() < robot.goal_count()) return kForever;
  return std::max(robot.goal->service_end(visits.back().t_arrive), robot.committed_until());
}

double previous_service_end(const Robot& robot) { return last_service_end(robot, previous_actions(robot)); }

Itinerary itinerary_of(const Robot& robot) {
  Itinerary itinerary;
  itinerary.committed = committed_trajectory(robot);
  itinerary.pose = robot.committed_end();
  itinerary.t_begin = robot.committed_until();
  if (!robot.committed.empty()) {
    ServedGoals served = served_goals(robot, robot.committed);
    itinerary.visited = std::move(served.visits);
    itinerary.first_goal = itinerary.visited.size();
    itinerary.arrived = served.arrived;
    itinerary.service_done = served.service_done;
  }
  for (std::size_t k = itinerary.first_goal; k < robot.goal_count(); ++k) {
    itinerary.goals.push_back(robot.goal_at(k));
  }
  return itinerary;
}

}  // namespace fleetplan::core
