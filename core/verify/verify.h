#pragma once

// The independent check of a plan, in continuous time and closed form. It shares no collision test with the
// search.

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "core/map/occupancy_grid.h"
#include "core/model/plan.h"
#include "core/model/robot.h"

namespace fleetplan::core {

/// Something that a plan does wrong.
struct Violation {
  enum class Kind { robot_collision, obstacle_collision, discontinuity, speed, wrong_start, wrong_goal };
  Kind kind;
  std::vector<std::size_t> robots;  // indices, ascending; two for robot_collision, one otherwise
  double t = 0.0;                   // seconds; for a collision, when the overlap is deepest
  double distance = 0.0;  // what was measured: metres, radians, seconds or metres (radians) per second
  double required = 0.0;  // what it had to be, same unit
  std::string detail;     // a sentence for people, with units; names no robots by index
};

/// The outcome of a check.
struct VerifyReport {
  std::vector<Violation> violations;  // by time, then kind, then robots
  std::optional<double>
      min_clearance;  // metres: smallest gap between two bare disks over all time; none below two robots
  bool valid() const { return violations.empty(); }
};

/// Checks `plans` (at most one a robot, any order) against the map and robots: robot against robot, robot
/// against obstacle and map edge, continuity, speeds, start and goal. A robot without a plan stands at its
/// start for ever; one with a plan rests where its last action ends. `tolerance` (>= 0) in metres, seconds
/// and radians. Robots need not form a valid Problem: starts that overlap or stand in an obstacle are
/// violations at t = 0.
VerifyReport verify(const OccupancyGrid& grid, const std::vector<Robot>& robots,
                    const std::vector<RobotPlan>& plans, double tolerance);

}  // namespace fleetplan::core
