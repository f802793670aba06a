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

/// Pairs of robots that collide, of which the first are listed.
struct Collisions {
  std::vector<Collision> listed = {};
  std::size_t total = 0;
};

/// Returns the pairs of robots that collide if all execute nothing but their commitments, and then stand:
/// pairs that overlap already, and pairs of which one robot cannot stop in time. `braking`: by robot, see
/// braking_of; a robot executes that, too, if its commitment ends before. Ends early when `work` is met.
Collisions collisions_of_commitments(const std::vector<Robot>& robots,
                                     const std::vector<std::vector<Action>>& braking, Work& work);

}  // namespace fleetplan::core
