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
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// More overlaps of robots than this are not listed one by one: a fleet heaped up in one place has millions.
inline constexpr std::size_t kMostCollisions = 10'000;

/// Something that a plan does wrong. All numbers are finite.
///
/// - robot_collision: two disks overlap; one for each time that they do so without a break. Distance between
///   the centres, and the sum of the radii.
/// - obstacle_collision: a disk overlaps a blocked cell or leaves the map; one an action, and one for all
///   actions through which it goes on. Distance from the centre (0: inside), and the radius.
/// - discontinuity: actions that do not follow each other in time or space, or do not do what their type
/// says,
///   or a cost that is not the last t_end. A gap or jump and 0, or a time and what it had to be. Also a
///   number that is not finite, or beyond 1e30: nothing else is then checked of that robot.
/// - speed: faster than the robot; the speed and the robot's, or for an action that takes no time the
/// duration
///   and the least one, seconds. Or a translation that leads off the line of its heading (which may be
///   forwards or backwards); by how many metres, and 0.
/// - wrong_start, wrong_goal: how far the first or the resting pose is from where it ought to be, and 0.
///   Parked robots must rest at their start, in any heading. A robot without a plan is unplanned, and fine.
struct Violation {
  enum class Kind { robot_collision, obstacle_collision, discontinuity, speed, wrong_start, wrong_goal };
  Kind kind;
  std::vector<std::size_t> robots;  // indices, ascending; two for robot_collision, one otherwise
  double t = 0.0;         // seconds; for a collision, when the overlap is deepest for the first time
  double distance = 0.0;  // what was measured: metres, radians, seconds or metres (radians) per second
  double required = 0.0;  // what it had to be, same unit
  std::string detail;     // a sentence for people, with units; names no robots by index
};

/// The outcome of a check.
struct VerifyReport {
  std::vector<Violation> violations;  // by time, then kind, then robots
  // Metres: smallest gap between two bare disks over all time; none below two (usable) robots.
  std::optional<double> min_clearance;
  bool valid() const { return violations.empty(); }
};

/// Checks `plans` (at most one a robot, any order) against the map and robots: robot against robot, robot
/// against obstacle and map edge, continuity, speeds, start and goal. A robot without a plan stands at its
/// start for ever; one with a plan rests where its last action ends. `tolerance` (>= 0) in metres, seconds
/// and radians. Robots need not form a valid Problem: starts that overlap or stand in an obstacle are
/// violations at t = 0. Exact in continuous time but for rounding, a few ulp of the largest coordinate
/// (1e-13 m on a map of 1 km). Throws std::invalid_argument on a plan of no robot or a second one of the
/// same.
VerifyReport verify(const OccupancyGrid& grid, const std::vector<Robot>& robots,
                    const std::vector<RobotPlan>& plans, double tolerance);

/// The same, but nothing if `stop` is met before the check is done. Thousands of robots that mill about in
/// one place take minutes.
std::optional<VerifyReport> verify(const OccupancyGrid& grid, const std::vector<Robot>& robots,
                                   const std::vector<RobotPlan>& plans, double tolerance,
                                   const StopCondition& stop);

}  // namespace fleetplan::core
