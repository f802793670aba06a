#include "core/sipp/search_space.h"

#include <algorithm>

#include "core/model/served_goals.h"

namespace fleetplan::core {

SearchSpace::SearchSpace(const Instance& instance, std::size_t robot)
    : itinerary_(instance.itinerary(robot)),
      vertices_(instance, robot),
      begins_in_goal_pose_(!instance.robot(robot).committed.empty() && !itinerary_.goals.empty() &&
                           is_in_pose(itinerary_.pose, itinerary_.goals.front())),
      costs_to_go_(goal_count()) {
  const auto& goals = vertices_.goals();
  for (const auto& goal : goals) {
    const auto first = std::find(goals.begin(), goals.end(), goal);
    first_equal_.push_back(static_cast<std::size_t>(first - goals.begin()));
  }
}

CostToGo& SearchSpace::cost_to_go(std::size_t goal) {
  auto& known = costs_to_go_[first_equal_[goal]];
  if (!known) known = std::make_unique<CostToGo>(vertices_, first_equal_[goal]);
  return *known;
}

std::int64_t SearchSpace::expansions() const {
  std::int64_t expansions = 0;
  for (const auto& cost : costs_to_go_) expansions += cost ? cost->expansions() : 0;
  return expansions;
}

std::size_t SearchSpace::bytes() const {
  std::size_t bytes = 0;
  for (const auto& cost : costs_to_go_) bytes += cost ? cost->bytes() : 0;
  return bytes;
}

}  // namespace fleetplan::core
