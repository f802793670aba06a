#include "core/prioritized/plan_state.h"

#include <algorithm>
#include <utility>

namespace fleetplan::core {
namespace {

/// Memory for the robots' costs-to-go; beyond it they are discarded and computed again.
constexpr std::size_t kMaxSearchSpaceBytes = std::size_t{384} << 20;

std::vector<double> radii(const Instance& instance) {
  std::vector<double> radii;
  radii.reserve(instance.size());
  for (std::size_t i = 0; i < instance.size(); ++i) radii.push_back(instance.motion(i).radius);
  return radii;
}

const Contacts* contacts(const Instance& instance) {
  return instance.contacts().empty() ? nullptr : &instance.contacts();
}

}  // namespace

PlanState::PlanState(const Instance& instance)
    : instance_(instance),
      table_(instance.problem().grid().width(), instance.problem().grid().height(),
             instance.problem().grid().resolution(), radii(instance), contacts(instance)),
      search_(table_),
      trajectories_(instance.size()),
      search_spaces_(instance.size()) {}

Trajectory PlanState::staying(std::size_t robot) const {
  return {instance_.robot(robot).start.position, {}, 0.0};
}

void PlanState::reserve(std::size_t robot, const std::vector<TimedSegment>& segments) {
  remove(robot);
  table_.commit(robot, segments);
}

void PlanState::remove(std::size_t robot) {
  table_.remove(robot);
  if (trajectories_[robot]) --planned_count_;
  trajectories_[robot].reset();
}

void PlanState::follow(std::size_t robot, Trajectory trajectory) {
  reserve(robot, timed_segments(trajectory));
  trajectories_[robot] = std::move(trajectory);
  ++planned_count_;
}

void PlanState::stay_at_start(std::size_t robot) { reserve(robot, timed_segments(staying(robot))); }

void PlanState::reserve_start(std::size_t robot, double seconds) {
  const Position start = instance_.robot(robot).start.position;
  remove(robot);
  if (seconds > 0.0) table_.commit(robot, {{{start, start}, 0.0, seconds}});
}

PlanState::SearchSpace& PlanState::search_space(std::size_t robot) {
  if (!search_spaces_[robot]) {
    discard_search_spaces_except(robot);
    search_spaces_[robot] = std::make_unique<SearchSpace>(instance_, robot);
  }
  return *search_spaces_[robot];
}

void PlanState::discard_search_spaces_except(std::size_t robot) {
  std::size_t bytes = 0;
  for (const auto& space : search_spaces_) bytes += space ? space->cost_to_go.bytes() : 0;
  if (bytes < kMaxSearchSpaceBytes) return;
  for (std::size_t i = 0; i < search_spaces_.size(); ++i) {
    if (i != robot) search_spaces_[i].reset();
  }
}

SearchResult PlanState::plan(std::size_t robot, const SearchLimits& limits, const StopCondition& stop) {
  SearchSpace& space = search_space(robot);
  SearchLimits within = limits;
  within.bound = std::min(limits.bound, instance_.longest_plan(robot));
  SearchResult result = search_.run(robot, space.vertices, space.cost_to_go, within, stop);
  expansions_ += result.expansions;
  return result;
}

SearchResult PlanState::plan_ignoring(const std::vector<std::size_t>& ignored, std::size_t robot,
                                      const SearchLimits& limits, const StopCondition& stop) {
  for (const std::size_t other : ignored) table_.ignore(other, true);
  SearchResult result = plan(robot, limits, stop);
  for (const std::size_t other : ignored) table_.ignore(other, false);
  return result;
}

bool PlanState::can_leave_start(std::size_t robot) {
  const Vertices& vertices = search_space(robot).vertices;
  bool can_leave = false;
  vertices.for_each_neighbour(vertices.start(), [&](int) { can_leave = true; });
  return can_leave;
}

bool PlanState::goal_reachable(std::size_t robot, const StopCondition& stop) {
  if (stop.met()) return true;
  SearchSpace& space = search_space(robot);
  const Vertices& vertices = space.vertices;
  return vertices.start() == vertices.goal() ||
         space.cost_to_go.from(vertices.start(), stop).seconds < kForever;
}

bool PlanState::takes_too_long(std::size_t robot, const StopCondition& stop) {
  SearchSpace& space = search_space(robot);
  const Vertices& vertices = space.vertices;
  return vertices.start() != vertices.goal() &&
         space.cost_to_go.from(vertices.start(), stop).seconds >= instance_.longest_plan(robot);
}

Trajectory PlanState::plan_alone(std::size_t robot, const StopCondition& stop) {
  const OccupancyGrid& grid = instance_.problem().grid();
  const double cell_size = grid.width();  // coarse, as the table stays empty
  const ReservationTable empty(grid.width(), grid.height(), cell_size, radii(instance_));
  SearchSpace& space = search_space(robot);
  AaSipp search(empty);
  SearchResult result = search.run(robot, space.vertices, space.cost_to_go, {}, stop);
  return result.trajectory ? std::move(*result.trajectory) : staying(robot);
}

std::vector<std::size_t> PlanState::conflicting_robots(std::size_t robot,
                                                       const Trajectory& trajectory) const {
  return table_.robots_hit(robot, timed_segments(trajectory));
}

std::vector<std::size_t> PlanState::robots_crossing_start(std::size_t robot) const {
  return conflicting_robots(robot, staying(robot));
}

}  // namespace fleetplan::core
