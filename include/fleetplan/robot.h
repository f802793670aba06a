#pragma once

#include <fleetplan/action.h>
#include <fleetplan/pose.h>

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace fleetplan {

/// One of several poses at which a goal may be served.
struct Alternative {
  double x = 0.0;  // metres
  double y = 0.0;
  std::optional<double> theta = {};  // radians; none: any heading
  double bias = 0.0;  // seconds, >= 0: added to the cost of choosing it, and to no time of the plan
};

/// A pose in which a robot comes to rest.
struct Goal {
  double x = 0.0;  // metres
  double y = 0.0;
  std::optional<double> theta = {};  // radians; none: any heading
  double service = 0.0;              // seconds, >= 0, at rest in the pose
  double not_before = 0.0;           // seconds, >= 0: the service begins at this time at the earliest
  /// Metres: the robot's radius after the service. None: the radius stays the same.
  std::optional<double> radius_after = {};
  /// Seconds: when the robot should arrive at the latest; see Options::Objective. `not_before` must not be
  /// later. A negative time is in the past. None: it is never late.
  std::optional<double> due = {};
  /// How the robot drives after the service, metres per second (squared). None: as before. Accelerations are
  /// only for robots whose acceleration is limited. A deceleration that is not given equals the acceleration.
  std::optional<double> linear_speed_after = {};
  std::optional<double> linear_acceleration_after = {};
  std::optional<double> linear_deceleration_after = {};
  /// From 2 to 100 poses, given instead of `x`, `y` and `theta`. The robot serves the goal at one of them.
  /// Empty: the goal has one pose.
  ///
  /// The planner chooses the pose before it plans the ways, by when robots would arrive
  /// (docs/plan_request.md). Visit::choice tells the chosen pose. Robots that stay at their last goals get
  /// poses at which they do not overlap.
  std::vector<Alternative> any_of = {};
  /// The number in `any_of` of the only pose at which `committed` and `previous` serve the goal. None: the
  /// pose in which they rest first. It does not bind the plan.
  std::optional<std::size_t> choice = {};
  /// Metres, 0 to 1. If the pose has no room or no way leads there, the goal is served at a place within this
  /// distance, with the same heading. Visit::place tells the place. Not together with `any_of`.
  double tolerance = 0.0;
  /// With a tolerance: the place at which `committed` and `previous` serve the goal. None: the goal's own
  /// pose.
  std::optional<Position> place = {};
};

/// A differential-drive robot: an open disk that waits, rotates in place or translates straight ahead (or
/// back, see `may_reverse`). Its speed changes at once, unless its acceleration is limited; then every
/// translation and rotation begins and ends at rest. Robots may touch, but not overlap. limits.h has the
/// ranges.
struct Robot {
  /// What the robot does without goals, and after its last goal.
  enum class Idle {
    stay,       // stays where it is; others keep clear of it
    yield,      // makes way if another robot needs the place, and ends anywhere
    come_back,  // makes way, and comes back
  };

  std::string id;              // for your own use; may be empty, need not be unique
  double radius = 0.0;         // metres, > 0
  double linear_speed = 0.0;   // metres per second, > 0
  double angular_speed = 0.0;  // radians per second, > 0
  Pose start;                  // pose at t = 0
  std::vector<Goal> goals;     // visited in this order
  Idle idle = Idle::stay;

  /// The actions that the robot executes whatever is planned. They are contiguous from t = 0 in `start`, no
  /// faster than the robot, and the last one ends at rest. The plan begins with these actions. Gaps of up to
  /// 5e-7 are closed.
  std::vector<Action> committed;
  /// The actions of an earlier plan, also from t = 0 in `start`, the committed ones included. The planner
  /// keeps them, or begins its search with them, see Options::replan.
  std::optional<std::vector<Action>> previous;

  bool may_reverse = false;  // it may translate backwards
  double vicinity = 0.0;     // metres, >= 0: added to its radius against other robots only
  /// Seconds, >= 0: how long the next goal has been waiting. With a horizon, robots whose goals have waited
  /// longest are planned first.
  double goal_age = 0.0;
  double weight = 1.0;  // > 0: its cost and its delays count so many times in the objective

  /// How fast speeds rise and fall, > 0: metres per second squared for translations, radians per second
  /// squared for rotations both ways. None: no limit. A deceleration that is not given equals the
  /// acceleration.
  std::optional<double> linear_acceleration = {};
  std::optional<double> linear_deceleration = {};
  std::optional<double> angular_acceleration = {};
};

}  // namespace fleetplan
