#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/prioritized/plan_state.h"
#include "core/prioritized/priority_order.h"
#include "core/prioritized/progress_report.h"
#include "core/runtime/random.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// How a repair ended.
struct RepairResult {
  std::vector<std::size_t> given_up;  // found no way among those that stay, and stand for ever now
  std::vector<std::size_t> unsolved;  // without a trajectory, by priority; not empty only if `stop` was met
  std::int64_t attempts = 1;          // one more for every robot that found no way
};

/// Plans all robots of `order`, which hold nothing yet, and raises the priority of those that fail as the
/// paper does, but repairs instead of starting again: the failed robot is planned among the higher ranked
/// alone; if that fails too it is raised to the top, and planned among the larger of the others and, as a
/// last resort, among nobody but those that stay. Only the trajectories that it crosses there are taken back
/// and planned again. Where robots keep raising each other, the priorities of those involved are shuffled.
RepairResult plan_with_repair(PlanState& state, const PriorityOrder& order, Random& random,
                              const StopCondition& stop, ProgressReport& progress);

}  // namespace fleetplan::core
