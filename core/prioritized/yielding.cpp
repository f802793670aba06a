#include "core/prioritized/yielding.h"

#include <utility>

namespace fleetplan::core {
namespace {

/// The effort for one robot.
constexpr std::int64_t kMostExpansions = 2'000;
/// Seconds: a gain below this is rounding.
constexpr double kLeastGain = 1e-6;

}  // namespace

bool undo_vain_moves(PlanState& state, const StopCondition& stop) {
  if (!state.any_yields()) return false;
  for (std::size_t robot = 0; robot < state.instance().size(); ++robot) {
    if (!state.makes_way(robot) || state.trajectory(robot)->is_previous) continue;
    if (stop.met()) return true;
    Trajectory now = *state.trajectory(robot);
    SearchLimits limits;
    limits.bound = now.cost - kLeastGain;
    limits.max_expansions = kMostExpansions;
    state.remove(robot);
    SearchResult result = state.plan(robot, limits, stop);
    state.follow(robot, result.trajectory ? std::move(*result.trajectory) : std::move(now));
  }
  return false;
}

}  // namespace fleetplan::core
