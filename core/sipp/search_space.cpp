#include "core/sipp/search_space.h"

#include <map>
#include <optional>
#include <tuple>
#include <utility>

#include "core/compile/instance.h"

namespace fleetplan::core {

SearchSpace::SearchSpace(const Instance& instance, std::size_t robot, const StopCondition& stop)
    : instance_(instance),
      robot_(robot),
      views_(&instance.views(robot)),
      itinerary_(instance.itinerary(robot)),
      costs_to_go_(goal_count()) {
  find_goals(stop);
}

SearchSpace::SearchSpace(const Instance& instance, std::size_t robot, Itinerary itinerary,
                         const StopCondition& stop)
    : instance_(instance),
      robot_(robot),
      views_(&instance.views(robot)),
      own_itinerary_(std::move(itinerary)),
      itinerary_(own_itinerary_),
      costs_to_go_(goal_count()) {
  find_goals(stop);
}

void SearchSpace::find_goals(const StopCondition& stop) {
  begins_in_goal_pose_ = itinerary_.is_committed && !itinerary_.is_parked() &&
                         is_in_pose(itinerary_.pose, itinerary_.goals.front());
  while (goals_at_start_ < goal_count() &&
         itinerary_.goals[goals_at_start_].position == itinerary_.pose.position) {
    ++goals_at_start_;
  }
  vertices_.push_back({std::make_unique<Vertices>(instance_, robot_, itinerary_, 0, stop), 0});
  if (changes_load() && finished()) add_vertices(stop);
  if (finished()) find_equal_goals();
}

SearchSpace::SearchSpace(const Instance& instance, std::size_t robot, const Goal& goal)
    : instance_(instance),
      robot_(robot),
      views_(&instance.views(robot)),
      own_itinerary_{.committed = {}, .pose = instance.itinerary(robot).pose, .visited = {}, .goals = {goal}},
      itinerary_(own_itinerary_),
      first_equal_{0},
      costs_to_go_(1) {
  vertices_.push_back({std::make_unique<Vertices>(instance, robot, goal), 0});
  cost_to_go(0);  // before there is a start
}

void SearchSpace::begin_at(std::size_t robot, bool any_heading) {
  robot_ = robot;
  views_ = &instance_.views(robot);
  any_heading_at_start_ = any_heading;
  own_itinerary_.pose = instance_.itinerary(robot).pose;
  vertices_.front().vertices->replace_start(instance_, robot);
  cost_to_go(0).replace_start();
}

void SearchSpace::add_vertices(const StopCondition& stop) {
  for (std::size_t stage = 1; stage <= goal_count(); ++stage) {
    if (views_->number(stage) < vertices_.size()) continue;
    const int first_vertex = vertex_count();
    vertices_.push_back(
        {std::make_unique<Vertices>(instance_, robot_, itinerary_, stage, stop), first_vertex});
    if (!finished()) return;
  }
}

void SearchSpace::find_equal_goals() {
  using Kind = std::tuple<int, std::optional<double>>;  // vertex, as first_vertex() numbers them, and heading
  std::map<Kind, std::size_t> first;
  for (std::size_t k = 0; k < goal_count(); ++k) {
    first_equal_.push_back(
        first.emplace(Kind(first_vertex(k) + goal_pose(k).vertex, goal_pose(k).heading), k).first->second);
  }
}

CostToGo& SearchSpace::cost_to_go(std::size_t goal) {
  auto& known = costs_to_go_[first_equal_[goal]];
  if (!known) known = std::make_unique<CostToGo>(vertices(goal), first_equal_[goal]);
  return *known;
}

std::size_t SearchSpace::bytes() const {
  std::size_t bytes = 0;
  for (const auto& cost : costs_to_go_) bytes += cost ? cost->bytes() : 0;
  return bytes;
}

}  // namespace fleetplan::core
