#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace fleetplan::core {

/// The outcome of planning robots in one or more priority orders. The trajectories are in the PlanState.
struct OrderingResult {
  std::vector<std::size_t> unsolved;  // without a trajectory, by priority; to be planned once more
  std::vector<std::size_t> given_up;  // no path among robots that stay, or failed too often; at their starts
  std::int64_t attempts = 1;          // times that robots were ordered and planned
  bool cut_off = false;               // the stop condition was met first
};

}  // namespace fleetplan::core
