#pragma once

#include <string>

#include "api/request/limits.h"

namespace fleetplan::bench {

/// The least that planning a fleet can take: each of its robots planned alone on the static map.
struct Alone {
  double seconds = 0.0;      // of all robots together, and of what they share
  double floor_share = 0.0;  // the area of all disks over the area of the free cells
};

/// Plans each robot of a valid body of POST /v1/plan alone, in one instance. So estimates and tests of moves
/// are shared, as in a plan of all of them. The body is read before. The time is the median of `repeats`.
Alone plan_alone(const std::string& body, const api::Limits& limits, int repeats);

}  // namespace fleetplan::bench
