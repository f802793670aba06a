#pragma once

// Random plans, and the positions of their robots over time, computed in the simplest way.

#include <algorithm>
#include <cstddef>
#include <random>
#include <vector>

#include "core/verify/verify.h"
#include "tests/support/plan_builder.h"

namespace fleetplan::core {

struct RandomFleet {
  std::vector<Robot> robots;
  std::vector<RobotPlan> plans;
  double makespan = 0.0;
};

/// Robots of various sizes and speeds that drive, turn and wait at random between points of a square of
/// `side` metres. Each has up to `max_actions` actions. Some have no plan. They may collide.
inline RandomFleet random_fleet(std::mt19937& random, std::size_t count, double side, int max_actions) {
  const auto uniform = [&random](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  RandomFleet fleet;
  for (std::size_t index = 0; index < count; ++index) {
    Robot robot;
    robot.radius = uniform(0.1, 0.6);
    robot.linear_speed = uniform(0.3, 2.0);
    robot.angular_speed = uniform(0.5, 4.0);
    robot.start = {Position(uniform(0, side), uniform(0, side)), uniform(-3, 3)};
    support::PlanBuilder builder(index, robot);
    const int actions = std::uniform_int_distribution<int>(0, max_actions)(random);
    for (int k = 0; k < actions; ++k) {
      switch (std::uniform_int_distribution<int>(0, 3)(random)) {
        case 0:
          builder.wait(uniform(0, 3));
          break;
        case 1:
          builder.rotate_to(uniform(-3, 3));
          break;
        default:
          builder.drive_to(uniform(0, side), uniform(0, side));
      }
    }
    fleet.robots.push_back(robot);
    if (actions == 0) continue;
    fleet.plans.push_back(builder.build());
    fleet.makespan = std::max(fleet.makespan, fleet.plans.back().cost);
  }
  return fleet;
}

/// The position at time t of a robot that executes these actions, or is at `start` without any.
inline Position sampled(const std::vector<Action>& actions, const Position& start, double t) {
  Position position = actions.empty() ? start : actions.front().from.position;
  for (const Action& action : actions) {
    if (t < action.t_start) break;
    const double duration = action.t_end - action.t_start;
    const double part = duration > 0.0 ? std::min(1.0, (t - action.t_start) / duration) : 1.0;
    position = (1.0 - part) * action.from.position + part * action.to.position;
  }
  return position;
}

/// The position of a robot of the fleet at time t; its plan is valid.
inline Position sampled_position(const RandomFleet& fleet, std::size_t robot, double t) {
  const auto plan = std::find_if(fleet.plans.begin(), fleet.plans.end(),
                                 [robot](const RobotPlan& one) { return one.robot == robot; });
  const Position& start = fleet.robots[robot].start.position;
  return plan == fleet.plans.end() ? start : sampled(plan->actions, start, t);
}

}  // namespace fleetplan::core
