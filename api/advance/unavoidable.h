#pragma once

// Which robots collide although everybody stops as soon as possible.

#include <cstddef>
#include <vector>

#include "core/model/action.h"
#include "core/model/robot.h"
#include "core/runtime/work.h"

namespace fleetplan::api {

/// Two robots whose disks overlap.
struct Collision {
  std::size_t first = 0;
  std::size_t second = 0;
  double t = 0.0;  // seconds: 0 if they overlap already, otherwise when they begin to
};

/// The pairs of robots that collide if all execute nothing but their commitments, and then stand: those that
/// overlap already, and those of which one cannot stop in time. `braking`: by robot, see braking_of; a robot
/// executes that, too, if its commitment ends before. Of many pairs, only the first are returned. Ends early
/// when the stop is met.
std::vector<Collision> unavoidable_collisions(const std::vector<core::Robot>& robots,
                                              const std::vector<std::vector<core::Action>>& braking,
                                              core::Work& stop);

}  // namespace fleetplan::api
