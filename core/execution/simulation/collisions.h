#pragma once

// Where robots that execute their plans meet each other or walls.

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "core/runtime/stop_condition.h"
#include "core/verify/execution.h"
#include "core/verify/geometry/obstacle_field.h"

namespace fleetplan::core {

/// One uninterrupted overlap of two disks, or of a disk and a wall (or the edge of the map).
struct ExecutedCollision {
  std::size_t first = 0;              // robot
  std::optional<std::size_t> second;  // robot, > first; nullopt: a wall
  double t = 0.0;                     // seconds: when it begins; with a wall, when it is deepest in a leg
  Position position{0.0, 0.0};        // then: the middle of the two centres, or the centre
  double depth = 0.0;                 // metres: the largest overlap
};

/// The collisions of an execution.
struct ExecutionCollisions {
  std::optional<ExecutedCollision> first;                  // the earliest one
  std::vector<std::pair<std::size_t, std::size_t>> pairs;  // of robots that collide, ascending
};

/// `legs` and `radii` (metres) by robot. Disks may overlap each other and walls by `tolerance` metres. Walls
/// are compared with the robots of `near_walls`. Returns none if `stop` is met first.
std::optional<ExecutionCollisions> find_collisions(const std::vector<std::vector<Leg>>& legs,
                                                   const std::vector<double>& radii, double tolerance,
                                                   const ObstacleField& field,
                                                   const std::vector<std::size_t>& near_walls,
                                                   const StopCondition& stop);

/// The first overlap of one robot and a wall, by legs. Ends early, with none, if `stop` is met.
std::optional<ExecutedCollision> find_wall(const ObstacleField& field, std::size_t robot,
                                           const std::vector<Leg>& legs, double radius, double tolerance,
                                           const StopCondition& stop);

}  // namespace fleetplan::core
