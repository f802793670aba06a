#include "core/sipp/search_space.h"

#include <algorithm>

#include "core/model/served_goals.h"

namespace fleetplan::core {

SearchSpace::SearchSpace(const Instance& instance, std::size_t robot)
    : instance_(instance),
      robot_(robot),
      itinerary_(instance.itinerary(robot)),
      begins_in_goal_pose_(!instance.robot(robot).committed.empty() && !itinerary_.goals.empty() &&
                           is_in_pose(itinerary_.pose, itinerary_.goals.front())),
      costs_to_go_(goal_count()) {
  layers_.push_back({std::make_unique<Vertices>(instance, robot), 0});
  if (changes_radius()) add_layers();
  for (std::size_t k = 0; k < goal_count(); ++k) {
    std::size_t first = 0;
    while (radius(first) != radius(k) || goal(first) != goal(k)) ++first;
    first_equal_.push_back(first);
  }
}

void SearchSpace::add_layers() {
  std::vector<double> radii{radius(0)};  // by layer
  for (std::size_t stage = 0; stage <= goal_count(); ++stage) {
    const auto known = std::find(radii.begin(), radii.end(), radius(stage));
    layer_of_stage_.push_back(static_cast<std::size_t>(known - radii.begin()));
    if (known != radii.end()) continue;
    radii.push_back(radius(stage));
    const int first_vertex = vertex_count();
    layers_.push_back({std::make_unique<Vertices>(instance_, robot_, stage), first_vertex});
  }
}

CostToGo& SearchSpace::cost_to_go(std::size_t goal) {
  auto& known = costs_to_go_[first_equal_[goal]];
  if (!known) known = std::make_unique<CostToGo>(vertices(goal), first_equal_[goal]);
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
