#include "core/sipp/search_space.h"

#include <map>
#include <optional>
#include <tuple>

namespace fleetplan::core {

SearchSpace::SearchSpace(const Instance& instance, std::size_t robot, const StopCondition& stop)
    : instance_(instance),
      robot_(robot),
      itinerary_(instance.itinerary(robot)),
      begins_in_goal_pose_(!instance.robot(robot).committed.empty() && !itinerary_.goals.empty() &&
                           is_in_pose(itinerary_.pose, itinerary_.goals.front())),
      costs_to_go_(goal_count()) {
  layers_.push_back({std::make_unique<Vertices>(instance, robot, 0, stop), 0});
  if (changes_radius() && finished()) add_layers(stop);
  if (finished()) find_equal_goals();
}

void SearchSpace::add_layers(const StopCondition& stop) {
  std::map<double, std::size_t> layer_of_radius{{radius(0), 0}};
  for (std::size_t stage = 0; stage <= goal_count(); ++stage) {
    const auto [known, is_new] = layer_of_radius.emplace(radius(stage), layers_.size());
    layer_of_stage_.push_back(known->second);
    if (!is_new) continue;
    const int first_vertex = vertex_count();
    layers_.push_back({std::make_unique<Vertices>(instance_, robot_, stage, stop), first_vertex});
    if (!finished()) return;
  }
}

void SearchSpace::find_equal_goals() {
  using Kind = std::tuple<double, int, std::optional<double>>;  // radius, vertex and heading
  std::map<Kind, std::size_t> first;
  for (std::size_t k = 0; k < goal_count(); ++k) {
    first_equal_.push_back(first.emplace(Kind(radius(k), goal(k).vertex, goal(k).heading), k).first->second);
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
