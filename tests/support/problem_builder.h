#pragma once

// Problems in one line: `make_problem(map, {robot_at(1, 2).to(5, 2), robot_at(5, 4)})`.

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "core/model/problem.h"

namespace fleetplan::support {

/// A robot of radius 0.4 m, 1 m/s and pi/2 rad/s, parked unless given a goal.
class RobotBuilder {
 public:
  RobotBuilder(double x, double y, double theta) {
    robot_.radius = 0.4;
    robot_.linear_speed = 1.0;
    robot_.angular_speed = 1.5707963267948966;
    robot_.start = {core::Position(x, y), theta};
  }
  RobotBuilder& to(double x, double y) {
    robot_.goal = core::Goal{core::Position(x, y), std::nullopt};
    return *this;
  }
  RobotBuilder& to(double x, double y, double theta) {
    robot_.goal = core::Goal{core::Position(x, y), theta};
    return *this;
  }
  RobotBuilder& radius(double metres) {
    robot_.radius = metres;
    return *this;
  }
  RobotBuilder& speeds(double linear, double angular) {
    robot_.linear_speed = linear;
    robot_.angular_speed = angular;
    return *this;
  }
  /// Adds committed actions: turns if necessary and drives to a point at full speed.
  RobotBuilder& drives(double x, double y) {
    const core::Position to(x, y);
    const core::Pose from = robot_.committed_end();
    const core::Position way = to - from.position;
    const double theta = std::atan2(way.y(), way.x());
    const double turn = std::abs(std::remainder(theta - from.theta, 2.0 * std::numbers::pi));
    if (turn > 0.0) {
      commit(core::Action::Type::rotate, turn / robot_.angular_speed, {from.position, theta});
    }
    commit(core::Action::Type::translate, way.norm() / robot_.linear_speed, {to, theta});
    return *this;
  }
  /// Adds a committed wait until `until`, seconds.
  RobotBuilder& waits(double until) {
    commit(core::Action::Type::wait, until - robot_.committed_until(), robot_.committed_end());
    return *this;
  }
  operator core::Robot() const { return robot_; }  // NOLINT(google-explicit-constructor): for lists of robots

 private:
  void commit(core::Action::Type type, double seconds, const core::Pose& to) {
    const double begin = robot_.committed_until();
    robot_.committed.push_back({type, begin, begin + seconds, robot_.committed_end(), to});
  }

  core::Robot robot_;
};

inline RobotBuilder robot_at(double x, double y, double theta = 0.0) { return {x, y, theta}; }

/// Returns the problem; throws std::invalid_argument if it has faults.
inline core::Problem make_problem(core::OccupancyGrid grid, std::vector<core::Robot> robots,
                                  core::ProblemConditions conditions = {}) {
  for (std::size_t i = 0; i < robots.size(); ++i) robots[i].id = std::to_string(i);
  auto problem = core::Problem::create(std::move(grid), std::move(robots), std::move(conditions),
                                       core::StopCondition::never());
  if (auto* valid = std::get_if<core::Problem>(&problem)) return std::move(*valid);
  throw std::invalid_argument("the robots and the map are not a valid problem");
}

/// A rectangular zone between two corners.
inline core::Zone box(core::Zone::Type type, const core::Position& low, const core::Position& high) {
  core::Zone zone;
  zone.id = "box";
  zone.type = type;
  zone.polygon = {low, {high.x(), low.y()}, high, {low.x(), high.y()}};
  return zone;
}

}  // namespace fleetplan::support
