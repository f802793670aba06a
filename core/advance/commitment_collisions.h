#pragma once

// Robots that collide by their commitments, whatever is planned.

#include <cstddef>
#include <vector>

#include "core/model/action.h"
#include "core/model/robot.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// Two robots whose disks overlap.
struct Collision {
  std::size_t first = 0;
  std::size_t second = 0;
  double t = 0.0;  // seconds: 0 if they overlap already, otherwise when they begin to
};

/// Pairs of robots that collide. Only the first of them are listed.
struct Collisions {
  std::vector<Collision> listed = {};
  std::size_t total = 0;
};

/// Returns the pairs of robots that collide if all execute only their commitments, and then stand. In such a
/// pair, the robots overlap already, or one of them cannot stop in time. `braking`: by robot, see braking_of.
/// A robot also executes its braking, if its commitment ends before. Ends early when `work` is met.
Collisions collisions_of_commitments(const std::vector<Robot>& robots,
                                     const std::vector<std::vector<Action>>& braking, Work& work);

}  // namespace fleetplan::core
