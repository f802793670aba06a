#include "core/model/itinerary.h"

#include <algorithm>

#include "core/geometry/angle.h"
#include "core/geometry/tolerance.h"

namespace fleetplan::core {
namespace {

bool is_in_pose(const Pose& pose, const Goal& goal) {
  return (pose.position - goal.position).norm() <= kContactTolerance &&
         (!goal.theta || angle_between(pose.theta, *goal.theta) <= kContactTolerance);
}

/// Follows the committed actions from rest to rest and serves one goal after the other.
class CommittedVisits {
 public:
  CommittedVisits(const Robot& robot, Itinerary& itinerary) : robot_(robot), itinerary_(itinerary) {}

  void run() {
    rest(robot_.start);
    for (const Action& action : robot_.committed) {
      if (action.type != Action::Type::wait) {
        arrived_ = action.t_end;
        done_ = 0.0;
      }
      now_ = action.t_end;
      rest(action.to);
    }
    if (robot_.goal && is_in_pose(itinerary_.pose, robot_.goal_at(next_))) {
      itinerary_.arrived = arrived_;
      itinerary_.service_done = done_;
    }
    itinerary_.first_goal = next_;
  }

 private:
  /// At rest in this pose from `arrived_` to `now_`.
  void rest(const Pose& pose) {
    done_ = 0.0;
    for (; next_ < robot_.goal_count() && is_in_pose(pose, robot_.goal_at(next_)); ++next_) {
      const Goal& goal = robot_.goal_at(next_);
      const double begin = std::max(arrived_, goal.not_before);
      done_ = std::clamp(now_ - begin, 0.0, goal.service);
      if (next_ + 1 == robot_.goal_count() || begin + goal.service > now_ + kSameTime) return;
      itinerary_.visited.push_back({next_, arrived_, begin + goal.service});
      arrived_ = begin + goal.service;
      done_ = 0.0;
    }
  }

  const Robot& robot_;
  Itinerary& itinerary_;
  std::size_t next_ = 0;  // goal
  double arrived_ = 0.0;  // at rest since then, or since the service of another goal in the same pose
  double now_ = 0.0;
  double done_ = 0.0;  // of the service of the next goal
};

Trajectory committed_trajectory(const Robot& robot) {
  Trajectory trajectory;
  trajectory.start = robot.start.position;
  for (const Action& action : robot.committed) {
    if (action.type != Action::Type::translate) continue;
    trajectory.moves.push_back(
        {{action.from.position, action.to.position}, action.t_start, action.t_end});
  }
  trajectory.cost = robot.committed_until();
  return trajectory;
}

}  // namespace

Itinerary itinerary_of(const Robot& robot) {
  Itinerary itinerary;
  itinerary.committed = committed_trajectory(robot);
  itinerary.pose = robot.committed_end();
  itinerary.t_begin = robot.committed_until();
  if (!robot.committed.empty()) CommittedVisits(robot, itinerary).run();
  for (std::size_t k = itinerary.first_goal; k < robot.goal_count(); ++k) {
    itinerary.goals.push_back(robot.goal_at(k));
  }
  return itinerary;
}

}  // namespace fleetplan::core
