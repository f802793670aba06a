#pragma once

#include <fleetplan/fault.h>
#include <fleetplan/map.h>
#include <fleetplan/options.h>
#include <fleetplan/robot.h>
#include <fleetplan/surroundings.h>

#include <stdexcept>
#include <vector>

namespace fleetplan {

/// What to plan for. All coordinates are in the frame in which Map::origin is given.
///
/// A problem is valid if
///
/// - all numbers are in their ranges (limits.h) and the lists are as their types describe,
/// - the disk of every robot is clear of blocked cells and zones at its start and goals, except for
///   Options::start_overlap and Options::goal_overlap,
/// - no two starts and no two last goals overlap, with the same exceptions,
/// - committed motion collides with nothing that is certain: walls, other committed motion, parked robots.
///
/// Overlaps of up to 5e-7 m are contact, and contact is allowed.
struct Problem {
  Map map;
  std::vector<Robot> robots = {};
  std::vector<MovingObstacle> obstacles = {};
  std::vector<Zone> zones = {};
};

/// Returns the faults of a problem and of the options for it, in the order of robots, at most 20. Returns
/// none if the problem can be planned, perhaps without the robots that Options::invalid_robots leaves out.
/// Geometry is examined only if all numbers are in their ranges. Takes milliseconds for a map of a million
/// cells.
std::vector<Fault> faults_of(const Problem& problem, const Options& options = {});

/// Thrown by functions that need a valid problem.
class InvalidProblem : public std::invalid_argument {
 public:
  /// Makes the exception from at least one fault. what() describes the first fault.
  explicit InvalidProblem(std::vector<Fault> faults);

  const std::vector<Fault>& faults() const { return faults_; }

 private:
  std::vector<Fault> faults_;
};

}  // namespace fleetplan
