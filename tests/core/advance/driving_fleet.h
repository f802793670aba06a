#pragma once

// Small fleets in motion, with robots that mostly drive along the line y = 1.

#include <cmath>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "core/advance/advance.h"
#include "core/advance/commitment_collisions.h"
#include "tests/support/unbounded_work.h"

namespace fleetplan::core {

inline Pose at_x(double x, double theta = 0.0) { return {{x, 1.0}, theta}; }

inline Moment moment(double at, std::optional<double> commit = {}, double wait_before_move = 0.0) {
  return {at, commit, 0.1, wait_before_move};
}

/// A robot with speeds of 1 m/s and 1 rad/s, without a goal.
inline Robot robot_at(const Pose& start, double radius = 0.25) {
  Robot robot;
  robot.radius = radius;
  robot.linear_speed = robot.angular_speed = 1.0;
  robot.start = start;
  return robot;
}

/// Robots and the plans that they execute.
struct DrivingFleet {
  std::vector<Robot> robots = {};
  std::vector<Execution> executions = {};
  double inflation = 0.0;

  void add(const Robot& robot, std::vector<Action> actions) {
    robots.push_back(robot);
    executions.push_back({std::move(actions), true});
  }

  /// Adds a robot that drives along the line at 1 m/s, or stands if it is at its goal.
  void add_on_line(double from, double to, double stop_distance = 0.0) {
    const double heading = to < from ? std::numbers::pi : 0.0;
    Robot robot = robot_at(at_x(from, heading));
    robot.goal = Goal{at_x(to).position, std::nullopt};
    std::vector<Action> actions;
    if (to != from) {
      actions.push_back({Action::Type::translate, 0.0, std::abs(to - from), robot.start, at_x(to, heading)});
    }
    add(robot, std::move(actions));
    executions.back().stop_distance = stop_distance;
  }

  std::vector<Robot> advance(double at, std::optional<double> commit = {}) const {
    Motions motions{braking(at, commit)};
    return advanced(robots, executions, moment_of(at, commit), motions, unbounded_work());
  }

  /// The collisions that robots cannot avoid from there on.
  std::vector<Collision> collisions(double at, double commit) const {
    return collisions_of_commitments(advance(at, commit), braking(at, commit), unbounded_work()).listed;
  }

 private:
  std::vector<std::vector<Action>> braking(double at, std::optional<double> commit) const {
    return braking_of(robots, executions, moment_of(at, commit), unbounded_work());
  }

  Moment moment_of(double at, std::optional<double> commit) const {
    Moment then = moment(at, commit);
    then.inflation = inflation;
    return then;
  }
};

}  // namespace fleetplan::core
