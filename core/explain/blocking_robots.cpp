#include "core/explain/blocking_robots.h"

#include <optional>
#include <utility>

namespace fleetplan::core {
namespace {

/// The expansions of all searches for blocking robots together: about a tenth of a second.
constexpr std::int64_t kMaxBlockingExpansions = 20'000;

}  // namespace

std::vector<std::size_t> BlockingRobots::find(std::size_t robot) {
  if (stop_.met()) return {};
  FleetReservations& reservations = state_.reservations();
  const Trajectory alone = state_.plan_alone(robot, stop_);
  std::vector<std::size_t> blocking = reservations.conflicting_robots(robot, alone);
  if (blocking.empty()) return reservations.robots_committed_against(robot, alone);
  const std::optional<Trajectory> followed = reservations.trajectory(robot);
  reservations.remove(robot);
  for (std::size_t k = 0; k < blocking.size() && blocking.size() > 1;) {
    if (stop_.met() || expansions_ > kMaxBlockingExpansions) break;
    const std::int64_t before = state_.expansions();
    std::vector<std::size_t> fewer = blocking;
    fewer.erase(fewer.begin() + static_cast<std::ptrdiff_t>(k));
    const auto found = state_.plan_ignoring(robot, fewer, {}, stop_).trajectory;
    if (found && !(followed && found->gains_nothing)) {
      blocking = std::move(fewer);
    } else {
      ++k;
    }
    expansions_ += state_.expansions() - before;
  }
  if (followed) {
    reservations.follow(robot, *followed);
  } else {
    reservations.stay_in_place(robot);
  }
  return blocking;
}

}  // namespace fleetplan::core
