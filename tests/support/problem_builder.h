#pragma once

// Problems in one line: `make_problem(map, {robot_at(1, 2).to(5, 2), robot_at(5, 4)})`.

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
  operator core::Robot() const { return robot_; }  // NOLINT(google-explicit-constructor): for lists of robots

 private:
  core::Robot robot_;
};

inline RobotBuilder robot_at(double x, double y, double theta = 0.0) { return {x, y, theta}; }

/// The problem; throws std::invalid_argument if it has faults.
inline core::Problem make_problem(core::OccupancyGrid grid, std::vector<core::Robot> robots) {
  for (std::size_t i = 0; i < robots.size(); ++i) robots[i].id = std::to_string(i);
  auto problem = core::Problem::create(std::move(grid), std::move(robots));
  if (auto* valid = std::get_if<core::Problem>(&problem)) return std::move(*valid);
  throw std::invalid_argument("the robots and the map are not a valid problem");
}

}  // namespace fleetplan::support
