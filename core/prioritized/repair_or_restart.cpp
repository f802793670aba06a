#include "core/prioritized/repair_or_restart.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "core/prioritized/repair.h"

namespace fleetplan::core {
namespace {

/// After so many failed attempts it is faster to start again with larger robots first: measured in the
/// paper's hall with rectangles and 240 to 300 robots, where 10 to 20 made no difference.
constexpr std::int64_t kMaxFailures = 15;
constexpr auto kAnyNumber = std::numeric_limits<std::int64_t>::max();

PriorityOrder larger_first(const Instance& instance, PriorityOrder order) {
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return instance.motion(a).pair_radius > instance.motion(b).pair_radius;
  });
  return order;
}

}  // namespace

OrderingResult repair_or_restart(PlanState& state, const PriorityOrder& order, Random& random,
                                 const StopCondition& stop, ProgressReport& progress, const OnStop& on_stop) {
  progress.next_attempt();
  if (!differ_in_size(state.instance(), order)) {
    return *repair(state, order, kAnyNumber, random, stop, progress, on_stop);
  }
  if (auto result = repair(state, order, kMaxFailures, random, stop, progress, on_stop))
    return std::move(*result);
  const PriorityOrder second = larger_first(state.instance(), order);
  OrderingResult result = *repair(state, second, kAnyNumber, random, stop, progress, on_stop);
  result.attempts += kMaxFailures;
  return result;
}

OrderingResult repair_once(PlanState& state, const PriorityOrder& order, Random& random,
                           const StopCondition& stop, ProgressReport& progress) {
  progress.next_attempt();
  return *repair(state, order, kAnyNumber, random, stop, progress);
}

}  // namespace fleetplan::core
