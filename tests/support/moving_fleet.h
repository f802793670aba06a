#pragma once

// Random requests for fleets in motion, and the same fleets at later moments of their plans.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "core/geometry/position.h"
#include "core/geometry/tolerance.h"
#include "core/map/occupancy_grid.h"
#include "core/model/loads.h"
#include "core/model/plan.h"
#include "core/model/plan_options.h"
#include "core/model/problem.h"
#include "tests/support/moments.h"
#include "tests/support/random_problem.h"

namespace fleetplan::support {

inline core::Position random_place(Dice& dice, const core::OccupancyGrid& grid) {
  return {dice.between(0.0, grid.width()), dice.between(0.0, grid.height())};
}

/// Adds some goals on the way, where the robot has room, some of them served for some time.
inline void add_goals(Dice& dice, const core::OccupancyGrid& grid, core::Robot& robot) {
  for (int attempt = dice.below(4); attempt > 0; --attempt) {
    core::Goal goal{random_place(dice, grid), {}};
    if (dice.chance(0.3)) goal.position = grid.center(grid.cell_at(goal.position));
    if (dice.chance(0.1)) goal.position = robot.start.position;
    if (core::obstacle_distance(grid, goal.position, robot.radius) < robot.radius) continue;
    if (dice.chance(0.5)) goal.theta = dice.between(-std::numbers::pi, std::numbers::pi);
    robot.via.push_back(goal);
    if (dice.chance(0.1)) robot.via.push_back(goal);
  }
  const auto add_service = [&](core::Goal& goal) {
    if (dice.chance(0.5)) goal.service = dice.between(0.0, 5.0);
    if (dice.chance(0.2)) goal.not_before = dice.between(0.0, 30.0);
  };
  for (core::Goal& goal : robot.via) add_service(goal);
  if (dice.chance(0.5)) add_service(*robot.goal);
}

/// Returns disks of the size of a robot that walk from place to place for half a minute.
inline std::vector<core::MovingObstacle> random_obstacles(Dice& dice, const core::OccupancyGrid& grid) {
  std::vector<core::MovingObstacle> obstacles;
  for (int k = dice.below(4); k > 0; --k) {
    core::MovingObstacle obstacle{
        "person " + std::to_string(k), grid.resolution() * dice.between(0.1, 0.8), {}, {}};
    core::Position here = random_place(dice, grid);
    for (double t = dice.between(0.0, 10.0); t < 40.0;) {
      obstacle.motion.push_back({t, here});
      const core::Position next = random_place(dice, grid);
      t += std::max(1.0, (next - here).norm() / (grid.resolution() * dice.between(0.3, 3.0)));
      here = next;
      if (dice.chance(0.2)) break;
    }
    obstacle.after =
        dice.chance(0.2) ? core::MovingObstacle::After::stays : core::MovingObstacle::After::leaves;
    obstacles.push_back(obstacle);
  }
  return obstacles;
}

/// What a request has, before it is known to be valid.
struct FleetRequest {
  core::OccupancyGrid grid;
  std::vector<core::Robot> robots;
  std::vector<core::MovingObstacle> obstacles;
  core::PlanOptions options;
  std::vector<core::Zone> zones = {};
};

inline std::optional<core::Problem> problem_of(const FleetRequest& request) {
  core::ProblemConditions conditions = core::conditions_of(request.options);
  conditions.obstacles = request.obstacles;
  conditions.zones = request.zones;
  auto created = core::Problem::create(request.grid, request.robots, std::move(conditions),
                                       core::StopCondition::never());
  auto* valid = std::get_if<core::Problem>(&created);
  return valid != nullptr ? std::optional<core::Problem>(std::move(*valid)) : std::nullopt;
}

/// Moves the first robot's start so near to the second robot that their bare disks overlap, or into a wall.
inline void overlap_starts(Dice& dice, FleetRequest& request) {
  if (request.robots.size() < 2) return;
  core::Robot& robot = request.robots[0];
  const core::Robot& other = request.robots[1];
  const double depth = 0.3 * std::min(robot.radius, other.radius) * dice.between(0.0, 1.0);
  const double direction = dice.between(-std::numbers::pi, std::numbers::pi);
  const core::Position start =
      other.start.position +
      (robot.radius + other.radius - depth) * core::Position(std::cos(direction), std::sin(direction));
  if (core::obstacle_distance(request.grid, start, robot.radius) < robot.radius - depth) return;
  for (std::size_t i = 2; i < request.robots.size(); ++i) {
    const core::Robot& third = request.robots[i];
    if ((third.start.position - start).norm() < third.radius + robot.radius) return;
  }
  robot.start.position = start;
  request.options.start_overlap = depth + 2.0 * request.options.inflation;
}

/// Moves last goals, where robots stay, towards walls and into them.
inline void push_goals_into_walls(Dice& dice, FleetRequest& request) {
  constexpr double kStep = 0.05;  // metres
  for (core::Robot& robot : request.robots) {
    if (!robot.goal || robot.yields() || !dice.chance(0.5)) continue;
    const double depth = 0.3 * robot.radius * dice.between(0.0, 1.0);
    const double kept = robot.radius - depth;
    const double heading = 0.5 * std::numbers::pi * dice.below(4);
    const core::Position step = kStep * core::Position(std::cos(heading), std::sin(heading));
    core::Position goal = robot.goal->position;
    for (int k = 0; k < 100 && core::obstacle_distance(request.grid, goal, kept) >= kept; ++k) {
      robot.goal->position = goal;
      goal += step;
    }
    request.options.goal_overlap =
        std::max(request.options.goal_overlap, depth + request.options.inflation + core::kContactTolerance);
  }
}

inline FleetRequest random_request(Dice& dice) {
  const core::Problem problem = random_problem(dice, 2 + dice.below(8));
  FleetRequest request{problem.grid(), problem.robots(), {}, random_options(dice, problem)};
  if (dice.chance(0.4)) request.options.interval_margin = dice.between(0.0, 2.0);
  if (dice.chance(0.2)) overlap_starts(dice, request);
  if (dice.chance(0.5)) request.options.replan = core::PlanOptions::Replan::where_needed;
  if (dice.chance(0.5)) request.obstacles = random_obstacles(dice, request.grid);
  for (core::Robot& robot : request.robots) {
    if (robot.goal && dice.chance(0.5)) add_goals(dice, request.grid, robot);
  }
  if (dice.chance(0.3)) {
    for (core::Robot& robot : request.robots)
      robot.vicinity = request.grid.resolution() * dice.between(0.0, 0.8);
  }
  if (dice.chance(0.3)) {
    for (core::Robot& robot : request.robots) robot.may_reverse = dice.chance(0.7);
  }
  return request;
}

/// Whether no other robot rests at its last goal within this disk.
inline bool may_rest(const std::vector<core::Robot>& robots, const core::Robot& robot, double radius) {
  for (const core::Robot& other : robots) {
    if (&other == &robot || !other.goal) continue;
    const double apart = (other.goal->position - robot.goal->position).norm();
    if (apart < radius + core::last_radius(other)) return false;
  }
  return true;
}

/// Makes a robot slower or faster at some goals; accelerations change only if they are limited.
inline void change_speeds(Dice& dice, core::Robot& robot) {
  const auto times = [&](double value) { return value * dice.between(0.3, 1.2); };
  for (std::size_t k = 0; k < robot.goal_count(); ++k) {
    core::Goal& goal = k < robot.via.size() ? robot.via[k] : *robot.goal;
    if (dice.chance(0.6)) goal.linear_speed_after = times(robot.linear_speed);
    if (!robot.linear_inertia().is_limited) continue;
    if (dice.chance(0.4)) goal.linear_acceleration_after = times(robot.linear_acceleration);
    if (dice.chance(0.3)) goal.linear_deceleration_after = times(robot.linear_deceleration);
  }
}

/// Makes robots grow or shrink at some goals, where there is room for them there and at the next goal. Makes
/// some of them slower or faster.
inline void add_loads(Dice& dice, FleetRequest& request) {
  for (core::Robot& robot : request.robots) {
    if (!robot.goal || dice.chance(0.2)) continue;
    if (dice.chance(0.4)) change_speeds(dice, robot);
    const std::size_t last = robot.via.size();
    for (std::size_t k = 0; k <= last; ++k) {
      const double radius = request.grid.resolution() * dice.between(0.15, 0.75);
      const auto fits = [&](std::size_t goal) {
        return core::obstacle_distance(request.grid, robot.goal_at(goal).position, radius) >= radius;
      };
      core::Goal& goal = k < last ? robot.via[k] : *robot.goal;
      bool has_room = may_rest(request.robots, robot, radius);
      for (std::size_t next = k; next <= last; ++next) has_room = has_room && fits(next);
      if (has_room && dice.chance(0.6)) goal.radius_after = radius;
    }
  }
}

/// Returns the request at a later moment of its plan.
inline FleetRequest moment_of(Dice& dice, const FleetRequest& request, const core::Plan& plan, double t) {
  FleetRequest next = request;
  next.options.start_safe_interval = dice.chance(0.7) ? 0.0 : 3.0;
  for (const core::RobotPlan& robot : plan.plans) {
    const double commit = dice.chance(0.2) ? 0.0 : dice.between(0.0, 5.0);
    next.robots[robot.robot] = robot_at_moment(request.robots[robot.robot], robot, t, commit);
  }
  for (const core::Unplanned& robot : plan.unplanned) {
    next.robots[robot.robot] = robot_at_moment(request.robots[robot.robot], t);
  }
  next.obstacles.clear();
  for (const core::MovingObstacle& obstacle : request.obstacles) {
    if (auto left = obstacle_at_moment(obstacle, t)) next.obstacles.push_back(std::move(*left));
  }
  return next;
}

/// Makes a robot stop where it is for some time.
inline void hold_back(Dice& dice, core::Robot& robot) {
  const double seconds = dice.between(0.5, 20.0);
  const core::Action wait{core::Action::Type::wait, 0.0, seconds, robot.start, robot.start};
  if (robot.previous) {
    robot.previous = later(*robot.previous, seconds);
    robot.previous->insert(robot.previous->begin(), wait);
  }
  robot.committed = {wait};
}

}  // namespace fleetplan::support
