#include "core/prioritized/yielding.h"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace fleetplan::core {
namespace {

/// The effort for one robot. Whether a robot without goals of its own may stay where it is takes none.
constexpr std::int64_t kMostExpansions = 2'000;
/// Seconds: a gain below this is rounding.
constexpr double kLeastGain = 1e-6;

/// Plans a robot that makes way for less cost, if that takes no more than `expansions_left`. Returns whether
/// it has found such a plan.
bool undo_vain_move(PlanState& state, std::size_t robot, std::int64_t& expansions_left,
                    const StopCondition& stop) {
  Trajectory now = *state.trajectory(robot);
  SearchLimits limits;
  limits.bound = now.cost - kLeastGain;
  limits.max_expansions = std::max<std::int64_t>(expansions_left, 1);
  state.remove(robot);
  SearchResult result = state.plan(robot, limits, stop);
  expansions_left -= result.expansions;
  const bool is_undone = result.trajectory.has_value();
  state.follow(robot, is_undone ? std::move(*result.trajectory) : std::move(now));
  return is_undone;
}

}  // namespace

bool undo_vain_moves(PlanState& state, const StopCondition& stop) {
  std::vector<std::size_t> makes_way;
  for (std::size_t robot = 0; robot < state.instance().size() && state.any_yields(); ++robot) {
    if (state.makes_way(robot) && !state.trajectory(robot)->is_previous) makes_way.push_back(robot);
  }
  if (makes_way.empty()) return false;
  if (stop.met()) return true;
  state.resume();
  std::vector<std::int64_t> expansions_left(state.instance().size(), kMostExpansions);
  // One that no longer makes way may have been what others made way for.
  for (bool is_any_undone = true; is_any_undone;) {
    is_any_undone = false;
    for (const std::size_t robot : makes_way) {
      if (stop.met()) return true;
      is_any_undone = undo_vain_move(state, robot, expansions_left[robot], stop) || is_any_undone;
    }
    std::erase_if(makes_way, [&](std::size_t robot) {
      const bool may_gain = expansions_left[robot] > 0 || state.instance().robot(robot).is_idle();
      return !state.makes_way(robot) || !may_gain;
    });
  }
  return false;
}

}  // namespace fleetplan::core
