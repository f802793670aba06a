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
  /// Metres: the radius of the robot from the end of the service on; none: as before.
  std::optional<double> radius_after = {};
  /// Seconds by which the robot should arrive, not before `not_before`; see Options::Objective. Negative: the
  /// past. None: it is never late.
  std::optional<double> due = {};
  /// How the robot drives from the end of the service on, metres per second (squared); none: as before.
  /// Accelerations are for robots that have one; a deceleration that is not given follows the acceleration.
  std::optional<double> linear_speed_after = {};
  std::optional<double> linear_acceleration_after = {};
  std::optional<double> linear_deceleration_after = {};
  /// From 2 to 100 poses, at one of which the goal is served, instead of `x`, `y` and `theta`: which one is
  /// chosen before the ways are planned, by when robots would arrive (docs/plan_request.md); Visit::choice
  /// tells it. Robots that stay at their last goals get poses at which they do not overlap. Empty: none.
  std::vector<Alternative> any_of = {};
  /// The number in `any_of` of the only pose at which `committed` and `previous` serve the goal; none: that
  /// in which they rest first. It does not bind the plan.
  std::optional<std::size_t> choice = {};
  /// Metres, 0 to 1: where the pose has no room or no way, the goal is served at a place so near to it, with
  /// the same heading; Visit::place tells where. Not together with `any_of`.
  double tolerance = 0.0;
  /// With a tolerance: the place at which `committed` and `previous` serve the goal; none: its own.
  std::optional<Position> place = {};
};

/// A differential-drive robot: an open disk that waits, rotates in place or translates straight ahead (or
/// back, see `may_reverse`). Its speed changes at once, unless acceleration is limited; then every
/// translation and rotation begins and ends at rest. Touching is allowed, overlapping is not. limits.h has
/// the ranges.
struct Robot {
  /// What it does without goals, and once it has served its last one.
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

  /// The actions that the robot executes whatever is planned: contiguous from t = 0 in `start`, none faster
  /// than the robot, and the last one to rest. The plan begins with these actions. Gaps of up to 5e-7 are
  /// closed.
  std::vector<Action> committed;
  /// The actions of an earlier plan, also from t = 0 in `start`, the committed ones included. The planner
  /// keeps them or begins with them, see Options::replan.
  std::optional<std::vector<Action>> previous;

  bool may_reverse = false;  // it may translate backwards
  double vicinity = 0.0;     // metres, >= 0: added to its radius against other robots only
  /// Seconds, >= 0, for which its next goal could have been served already: with a horizon, robots whose
  /// goals are older are planned first.
  double goal_age = 0.0;
  double weight = 1.0;  // > 0: its cost and its delays count so many times in the objective

  /// Metres per second squared, > 0: how fast the speed of a translation rises and falls; radians per second
  /// squared, of rotations both ways. None: no limit; of the deceleration: that of the acceleration.
  std::optional<double> linear_acceleration = {};
  std::optional<double> linear_deceleration = {};
  std::optional<double> angular_acceleration = {};
};

}  // namespace fleetplan
