#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "core/geometry/position.h"
#include "core/geometry/speed_profile.h"
#include "core/model/action.h"

namespace fleetplan::core {

/// A pose in which a robot comes to rest. Without theta, the heading is free.
struct Goal {
  Position position{0.0, 0.0};
  std::optional<double> theta;  // radians, (-pi, pi]
  double service = 0.0;         // seconds, >= 0, at rest in the pose
  double not_before = 0.0;      // seconds, >= 0; the service begins at this time at the earliest
  /// Metres: the robot's radius after the service. nullopt: the radius stays the same.
  std::optional<double> radius_after = {};
  /// Seconds: when the robot should arrive at the latest, see PlanOptions::Objective. A negative time is in
  /// the past.
  std::optional<double> due = {};
  /// True: the goal has no pose of its own, but any place where the robot may rest for good. It is the last
  /// goal of a robot that makes way when it has nothing else to do (Robot::yields). Then `position` is the
  /// position of the goal before, or where the plan begins.
  bool anywhere = false;
  /// How the robot drives after the service (metres per second, metres per second squared). nullopt: as
  /// before. A deceleration that is not given equals an acceleration that is given.
  std::optional<double> linear_speed_after = {};
  std::optional<double> linear_acceleration_after = {};
  std::optional<double> linear_deceleration_after = {};

  /// When the service ends if the robot comes to rest in the pose at this time; seconds.
  double service_end(double t_rest) const { return std::max(t_rest, not_before) + service; }

  /// Whether the robot's load changes at the end of the service. Its radius, or how it drives, then changes,
  /// too.
  bool changes_load() const {
    return radius_after || linear_speed_after || linear_acceleration_after || linear_deceleration_after;
  }
};

/// A differential-drive robot: an open disk that waits, rotates in place or translates straight ahead (or
/// back, see `may_reverse`; paper, Problem Statement). Its speed changes at once, unless acceleration is
/// limited; then every translation and rotation begins and ends at rest.
///
/// It visits the goals of `via` in their order and then `goal`, where it stays. Goals are numbered in this
/// order from 0. A goal is visited when the robot is at rest in its pose for the whole service, after the
/// goals before it. The last one may be anywhere (Goal::anywhere).
struct Robot {
  std::string id;
  double radius = 0.0;         // metres, > 0
  double linear_speed = 0.0;   // metres per second, > 0
  double angular_speed = 0.0;  // radians per second, > 0
  Pose start;                  // at t = 0
  std::optional<Goal> goal;    // nullopt: parked, it stays at its start or its committed end
  std::vector<Goal> via = {};  // visited before `goal`
  /// The actions that the robot executes whatever is planned. They are contiguous from t = 0 in `start`. The
  /// plan goes on from their end.
  std::vector<Action> committed = {};
  /// The actions of an earlier plan, from t = 0 in `start`, the committed ones included. nullopt if there is
  /// none.
  std::optional<std::vector<Action>> previous = {};
  /// Whether the robot's geometry is at fault. Then it stands at its start for ever, as an obstacle.
  bool invalid = false;
  bool may_reverse = false;  // it may translate backwards
  double vicinity = 0.0;     // metres, >= 0, added to its radius against other robots only
  double goal_age = 0.0;     // seconds, >= 0, for which its next goal could have been served already
  double weight = 1.0;       // > 0: how many times its cost and its tardiness count
  static constexpr double kNoLimit = std::numeric_limits<double>::infinity();
  double linear_acceleration = kNoLimit;   // metres per second squared, > 0
  double linear_deceleration = kNoLimit;   // metres per second squared, > 0
  double angular_acceleration = kNoLimit;  // radians per second squared, > 0, both ways

  Inertia linear_inertia() const { return {1.0 / linear_acceleration, 1.0 / linear_deceleration}; }
  Inertia angular_inertia() const { return {1.0 / angular_acceleration, 1.0 / angular_acceleration}; }
  /// Whether the speed of actions of this type changes within limits. Loads change limits, but a robot
  /// without limits gets none.
  bool limits_changes_of_speed(Action::Type type) const {
    if (type == Action::Type::wait) return false;
    return (type == Action::Type::rotate ? angular_inertia() : linear_inertia()).is_limited;
  }

  std::size_t goal_count() const { return via.size() + (goal ? 1 : 0); }
  /// Whether it makes way for others after its own goals, or because it has none.
  bool yields() const { return goal && goal->anywhere; }
  /// Whether it yields and has no goals of its own. Then it need not move.
  bool is_idle() const { return yields() && via.empty(); }
  /// The goals that have a pose.
  std::size_t own_goal_count() const { return goal_count() - (yields() ? 1 : 0); }
  /// Appends the goal that makes it yield.
  void let_yield() {
    Goal place{goal ? goal->position : committed_end().position, std::nullopt};
    place.anywhere = true;
    if (goal) via.push_back(*goal);
    goal = place;
  }
  const Goal& goal_at(std::size_t index) const { return index < via.size() ? via[index] : *goal; }
  /// The pose in which the committed actions end, and the time in seconds. Without any, the start and 0.
  Pose committed_end() const { return committed.empty() ? start : committed.back().to; }
  double committed_until() const { return committed.empty() ? 0.0 : committed.back().t_end; }
  /// The speed at which the profile of a committed translation begins, metres per second; negative when
  /// backwards. 0 if there is no profile.
  double committed_speed() const {
    if (committed.empty() || committed.front().type != Action::Type::translate) return 0.0;
    const Action& first = committed.front();
    const double speed = first.profile ? first.profile->start : 0.0;
    return first.reverse ? -speed : speed;
  }
};

}  // namespace fleetplan::core
