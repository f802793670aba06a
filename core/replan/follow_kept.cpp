#include "core/replan/follow_kept.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "core/replan/previous_plan.h"

namespace fleetplan::core {

std::size_t follow_kept_plans(PlanState& state, const KeptPlans& previous, const KeptPlans& certain) {
  std::size_t followed = 0;
  for (std::size_t robot = 0; robot < previous.kept.size(); ++robot) {
    if (!previous.kept[robot]) continue;
    Trajectory trajectory = previous_trajectory(state.instance().robot(robot));
    // The checker has accepted all that are kept together, and against what all robots are committed to.
    const auto is_kept = [&](std::size_t other) { return bool(previous.kept[other]); };
    const std::vector<std::size_t> others = state.conflicting_robots(robot, trajectory);
    if (!certain.contains(robot) && !std::all_of(others.begin(), others.end(), is_kept)) continue;
    state.follow(robot, std::move(trajectory));
    ++followed;
  }
  return followed;
}

void finish_with_kept_plans(PlanState& state, const std::vector<std::size_t>& movers) {
  PlanState::Reservations reservations = state.reservations();
  for (const std::size_t robot : movers) {
    reservations.trajectories[robot] = previous_trajectory(state.instance().robot(robot));
  }
  state.finish_with(reservations);
}

}  // namespace fleetplan::core
