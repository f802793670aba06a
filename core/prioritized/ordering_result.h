#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace fleetplan::core {

/// Called when the stop condition of an attempt is met, with its unsolved and given up robots. Returns
/// whether the attempt goes on, with the same reservations; then the stop condition is no longer met.
using OnStop =
    std::function<bool(const std::vector<std::size_t>& unsolved, const std::vector<std::size_t>& given_up)>;

/// The outcome of planning robots in one or more priority orders. The trajectories are in the PlanState.
struct OrderingResult {
  std::vector<std::size_t> unsolved;  // without a trajectory, by priority; to be planned once more
  std::vector<std::size_t> given_up;  // no path among robots that stay, or failed too often; at their starts
  /// Those of given_up that have no path even if all others that may move are absent, now and in any order.
  std::vector<std::size_t> hopeless;
  std::int64_t attempts = 1;  // times that robots were ordered and planned
  bool cut_off = false;       // the stop condition was met first
};

}  // namespace fleetplan::core
