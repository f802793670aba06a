#pragma once

// What a robot has served of its goals at the end of some actions, and what is left to plan.

#include <cstddef>
#include <span>
#include <vector>

#include "core/model/action.h"
#include "core/model/robot.h"
#include "core/model/trajectory.h"

namespace fleetplan::core {

/// Whether a robot in this pose is in the goal's, within kContactTolerance; without theta any heading will
/// do.
bool is_in_pose(const Pose& pose, const Goal& goal);

/// The goals that a robot has served at the end of some actions. The last goal always remains.
struct ServedGoals {
  std::vector<Visit> visits;  // the goals from the first one on
  bool in_next_pose = false;  // at the end it is at rest in the pose of the next goal, visits.size():
  double arrived = 0.0;       // since then, or since the end of the visit before
  double service_done = 0.0;  // seconds of its service
};

/// `actions` are contiguous from t = 0 in the robot's start. Each goal is served as early as possible: by an
/// uninterrupted rest in its pose, or in the instant between two actions if it has no service.
ServedGoals served_goals(const Robot& robot, std::span<const Action> actions);

/// The visits to all goals of a robot that stays where these actions end: the last one has no end. Fewer if
/// the robot does not serve all of them.
std::vector<Visit> visits_of(const Robot& robot, std::span<const Action> actions);

/// What is left to plan for a robot after its committed actions.
struct Itinerary {
  Trajectory committed;        // the robot's centre until `t_begin`; then it stays
  Pose pose;                   // at `t_begin`
  double t_begin = 0.0;        // seconds; the plan goes on from here
  std::vector<Visit> visited;  // goals that the committed actions serve
  std::vector<Goal> goals;     // that follow, the last one included; empty for a parked robot
  std::size_t first_goal = 0;  // the number of goals.front() among all goals of the robot
  /// If the committed actions end at rest in the first goal's pose: since when it rests there, and how much
  /// of the service is done. This counts only as long as the robot does not leave. Seconds.
  double arrived = 0.0;
  double service_done = 0.0;
};

/// The goals are served as early as possible by the rests of the committed actions. The last goal always
/// remains. A part of a service that is done counts if the robot goes on with it.
Itinerary itinerary_of(const Robot& robot);

}  // namespace fleetplan::core
