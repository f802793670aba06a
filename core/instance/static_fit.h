#pragma once

// How the disks of robots, inflated or not, fit among the walls where their plans begin and end.

#include <cstddef>

#include "core/geometry/position.h"
#include "core/instance/instance.h"

namespace fleetplan::core {

/// The largest disk of the robot that fits where its plan begins: its radius, or less where a wall is nearer.
double radius_at_start(const Instance& instance, std::size_t robot);
/// The largest one that fits at the goal of a stage, where a wall may be nearer by a contact only.
double radius_at_goal(const Instance& instance, std::size_t robot, const Position& goal, std::size_t stage);

/// Whether the robot's disk fits where its plan begins.
bool fits_at_start(const Instance& instance, std::size_t robot);
/// Whether no wall is nearer than in contact where the robot's plan begins.
bool is_clear_at_start(const Instance& instance, std::size_t robot);
/// Whether the robot's disk fits at all goals that are left, or is in contact with a wall.
bool fits_at_goals(const Instance& instance, std::size_t robot);
/// Whether its disk fits at this position on the way to its first goal, or is in contact with a wall.
bool fits_at(const Instance& instance, std::size_t robot, const Position& position);

}  // namespace fleetplan::core
