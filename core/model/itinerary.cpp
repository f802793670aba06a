#include "core/model/itinerary.h"

#include <algorithm>
#include <utility>

#include "core/geometry/angle.h"
#include "core/geometry/segment.h"
#include "core/geometry/tolerance.h"

namespace fleetplan::core {
namespace {

/// Follows the actions from rest to rest and serves one goal after the other.
class GoalService {
 public:
  explicit GoalService(const Robot& robot) : robot_(robot) {}

  ServedGoals run(std::span<const Action> actions) {
    Pose pose = robot_.start;
    rest(pose);
    for (const Action& action : actions) {
      if (action.type != Action::Type::wait) arrived_ = action.t_end;
      now_ = action.t_end;
      pose = action.to;
      rest(pose);
    }
    if (robot_.goal && is_in_pose(pose, robot_.goal_at(next()))) {
      served_.in_next_pose = true;
      served_.arrived = arrived_;
      served_.service_done = done_;
    }
    return std::move(served_);
  }

 private:
  std::size_t next() const { return served_.visits.size(); }

  /// Serves the goals in this pose, in which the robot is at rest from `arrived_` to `now_`.
  void rest(const Pose& pose) {
    done_ = 0.0;
    for (; next() < robot_.goal_count() && is_in_pose(pose, robot_.goal_at(next()));) {
      const Goal& goal = robot_.goal_at(next());
      const double begin = std::max(arrived_, goal.not_before);
      done_ = std::clamp(now_ - begin, 0.0, goal.service);
      if (next() + 1 == robot_.goal_count() || begin + goal.service > now_ + kSameTime) return;
      served_.visits.push_back({next(), arrived_, begin + goal.service});
      arrived_ = begin + goal.service;
      done_ = 0.0;
    }
  }

  const Robot& robot_;
  ServedGoals served_;
  double arrived_ = 0.0;  // begin of the rest, or end of the service of another goal in the same pose
  double now_ = 0.0;
  double done_ = 0.0;  // seconds of the service of the next goal
};

}  // namespace

bool is_in_pose(const Pose& pose, const Goal& goal) {
  if (goal.anywhere) return true;
  return (pose.position - goal.position).norm() <= kContactTolerance &&
         (!goal.theta || angle_between(pose.theta, *goal.theta) <= kContactTolerance);
}

bool has_arrived(const Robot& robot) {
  return robot.via.empty() && robot.goal->service == 0.0 && is_in_pose(robot.committed_end(), *robot.goal);
}

ServedGoals served_goals(const Robot& robot, std::span<const Action> actions) {
  return GoalService(robot).run(actions);
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
    trajectory.moves.push_back({{action.from.position, action.to.position}, action.t_start, action.t_end});
    if (!action.profile) continue;
    trajectory.profiles.resize(trajectory.moves.size());
    trajectory.profiles.back() = action.profile;
  }
  trajectory.cost = robot.committed_until();
  return trajectory;
}

}  // namespace

const std::vector<Action>& previous_actions(const Robot& robot) {
  return robot.goal && robot.previous && !robot.previous->empty() ? *robot.previous : robot.committed;
}

double previous_service_end(const Robot& robot) {
  const std::vector<Visit> visits = visits_of(robot, previous_actions(robot));
  if (visits.size() < robot.goal_count()) return kForever;
  const double end = std::max(visits.back().t_arrive, robot.goal->not_before) + robot.goal->service;
  return std::max(end, robot.committed_until());
}

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
