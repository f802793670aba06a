#pragma once

// Fleets whose plans are executed with disturbances.

#include <cstddef>
#include <utility>
#include <vector>

#include "core/execution/simulation/simulation.h"
#include "tests/core/verify/random_fleet.h"
#include "tests/core/verify/scene.h"

namespace fleetplan::core {

/// The fleet with an execution of its plans; refers to the arguments.
inline SimulatedFleet simulated(const OccupancyGrid& grid, const std::vector<Robot>& robots,
                                const std::vector<RobotPlan>& plans,
                                ExecutionPolicy policy = ExecutionPolicy::open_loop) {
  PlannedExecution execution{plans, {}};
  execution.policy = policy;
  for (const RobotPlan& plan : plans) {
    execution.purposes.push_back(wait_purposes(robots[plan.robot], plan.actions, 0.0));
  }
  std::vector<double> radii;
  for (const Robot& robot : robots) radii.push_back(robot.radius);
  return {grid, robots, std::move(radii), std::move(execution)};
}

/// All kinds of disturbances at once.
inline Disturbance rough() {
  Disturbance disturbance;
  disturbance.speed = {0.5, 1.0};
  disturbance.turn = {0.7, 1.0};
  disturbance.stops = {600.0, 3.0};
  disturbance.start_delay = {0.0, 0.4};
  return disturbance;
}

inline ExecutionKnot knot_at(const ExecutedProgress& progress, double t) {
  ExecutionKnot at;
  for (std::size_t k = 0; k < progress.knots.size() && progress.knots[k].t <= t; ++k) {
    at = progress.knots[k];
    if (k + 1 == progress.knots.size()) break;
    const ExecutionKnot& next = progress.knots[k + 1];
    if (next.t <= t || next.action != at.action) continue;
    at.fraction += (t - at.t) / (next.t - at.t) * (next.fraction - at.fraction);
  }
  return at;
}

}  // namespace fleetplan::core
