#pragma once

#include <cstddef>
#include <vector>

#include "core/model/robot.h"
#include "core/model/trajectory.h"
#include "core/model/visit.h"

namespace fleetplan::core {

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
