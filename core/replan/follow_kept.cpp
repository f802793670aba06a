#include "core/replan/follow_kept.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "core/replan/previous_plan.h"

namespace fleetplan::core {

std::size_t follow_kept_plans(PlanState& state, const KeptPlans& previous) {
  std::size_t followed = 0;
  for (std::size_t robot = 0; robot < previous.kept.size(); ++robot) {
    if (!previous.kept[robot]) continue;
    Trajectory trajectory = previous_trajectory(state.instance().robot(robot));
    // The checker has accepted all that are kept together.
    const auto all_kept = [&](const std::vector<std::size_t>& robots) {
      return std::all_of(robots.begin(), robots.end(), [&](auto other) { return previous.kept[other]; });
    };
    if (!all_kept(state.conflicting_robots(robot, trajectory)) ||
        !all_kept(state.robots_committed_against(robot, trajectory))) {
      continue;
    }
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
