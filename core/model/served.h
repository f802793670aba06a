#pragma once

// Which goals a robot serves by its actions. Only this file decides it, except for the checker, which has its
// own code.

#include <cstddef>
#include <span>
#include <vector>

#include "core/model/action.h"
#include "core/model/robot.h"
#include "core/model/trajectory.h"

namespace fleetplan::core {

/// Whether a robot in this pose is in the goal's pose, within kContactTolerance. For a goal without theta,
/// any heading is right. For a goal that is anywhere, any pose is right.
bool is_in_pose(const Pose& pose, const Goal& goal);

/// Follows the actions of a robot from rest to rest, contiguous from t = 0 in its start. It serves one goal
/// after the other, each as early as possible, by an uninterrupted rest in the goal's pose. Without a
/// service, the instant between two actions is enough. The last goal always remains.
class GoalsOnTheWay {
 public:
  /// `robot` outlives this object.
  explicit GoalsOnTheWay(const Robot& robot);

  void execute(const Action& action);
  /// The number of goals that it has served.
  std::size_t count() const { return visits_.size(); }
  /// The visits to them, in their order.
  const std::vector<Visit>& visits() const { return visits_; }
  /// When the rest began, or when the service of another goal in the same pose ended; seconds.
  double arrived() const { return arrived_; }
  /// How much of the service at the next goal is done, seconds.
  double service_done() const { return service_done_; }

 private:
  void rest(const Pose& pose);

  const Robot& robot_;
  std::vector<Visit> visits_;
  double arrived_ = 0.0;
  double now_ = 0.0;
  double service_done_ = 0.0;
};

/// The goals that a robot has served at the end of some actions. The last goal always remains.
struct ServedGoals {
  std::vector<Visit> visits;  // to the first goals, in their order
  bool in_next_pose = false;  // at the end, the robot is at rest in the pose of the next goal, visits.size()
  double arrived = 0.0;       // seconds: the begin of that rest, or the end of the visit before
  double service_done = 0.0;  // seconds of the service at the next goal that are done
};

/// Returns the goals that a robot has served at the end of `actions`, see GoalsOnTheWay.
ServedGoals served_goals(const Robot& robot, std::span<const Action> actions);

/// Returns the visits to the goals of a robot that stays where `actions` end; the visit to the last goal has
/// no end. There are fewer visits than goals if the robot does not serve all of them.
std::vector<Visit> visits_of(const Robot& robot, std::span<const Action> actions);

/// Marks the waits of a robot with the goals that they serve: goals with a service or a `not_before`, by the
/// visits that the actions make. Other waits get no mark. A wait from `first` on that contains several
/// services is divided. A wait before `first` is marked with the first of its goals.
void mark_services(const Robot& robot, std::vector<Action>& actions, std::size_t first);

/// Returns the actions of the robot's previous plan as received. Returns none for a robot that is parked or
/// has no previous plan: it rests after its committed actions.
const std::vector<Action>& previous_actions(const Robot& robot);

/// Returns when the service at the last goal ends, seconds, for a robot with a goal that stays where
/// `actions` end. Returns kForever if it does not serve all goals. A committed service does not end before
/// the commitment ends.
double last_service_end(const Robot& robot, std::span<const Action> actions);
/// The same by the robot's previous plan.
double previous_service_end(const Robot& robot);

}  // namespace fleetplan::core
