#include "core/prioritized/plan_state.h"

#include <utility>

namespace fleetplan::core {
namespace {

/// Memory for the robots' costs-to-go; beyond it they are computed again.
constexpr std::size_t kMaxGuideBytes = std::size_t{384} << 20;

std::vector<double> radii(const Instance& instance) {
  std::vector<double> radii;
  radii.reserve(instance.size());
  for (std::size_t i = 0; i < instance.size(); ++i) radii.push_back(instance.motion(i).radius);
  return radii;
}

}  // namespace

PlanState::PlanState(const Instance& instance)
    : instance_(instance),
      table_(instance.problem().grid().width(), instance.problem().grid().height(),
             instance.problem().grid().resolution(), radii(instance)),
      search_(table_),
      trajectories_(instance.size()),
      guides_(instance.size()) {}

Trajectory PlanState::standing(std::size_t robot) const {
  return {instance_.robot(robot).start.position, {}, 0.0};
}

void PlanState::reserve(std::size_t robot, const std::vector<TimedSegment>& segments) {
  leave(robot);
  table_.commit(robot, segments);
}

void PlanState::leave(std::size_t robot) {
  table_.remove(robot);
  if (trajectories_[robot]) --following_;
  trajectories_[robot].reset();
}

void PlanState::follow(std::size_t robot, Trajectory trajectory) {
  reserve(robot, timed_segments(trajectory));
  trajectories_[robot] = std::move(trajectory);
  ++following_;
}

void PlanState::stand_for_ever(std::size_t robot) { reserve(robot, timed_segments(standing(robot))); }

void PlanState::block_start(std::size_t robot, double seconds) {
  const Position start = instance_.robot(robot).start.position;
  leave(robot);
  if (seconds > 0.0) table_.commit(robot, {{{start, start}, 0.0, seconds}});
}

PlanState::Guide& PlanState::guide(std::size_t robot) {
  if (!guides_[robot]) {
    forget_other_guides(robot);
    guides_[robot] = std::make_unique<Guide>(instance_, robot);
  }
  return *guides_[robot];
}

void PlanState::forget_other_guides(std::size_t robot) {
  std::size_t bytes = 0;
  for (const auto& guide : guides_) bytes += guide ? guide->cost_to_go.bytes() : 0;
  if (bytes < kMaxGuideBytes) return;
  for (std::size_t i = 0; i < guides_.size(); ++i) {
    if (i != robot) guides_[i].reset();
  }
}

SearchResult PlanState::plan(std::size_t robot, const SearchLimits& limits, const StopCondition& stop) {
  Guide& g = guide(robot);
  SearchResult result = search_.run(robot, g.vertices, g.cost_to_go, limits, stop);
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

bool PlanState::goal_reachable(std::size_t robot, const StopCondition& stop) {
  if (stop.met()) return true;  // not known
  Guide& g = guide(robot);
  return g.vertices.start() == g.vertices.goal() ||
         g.cost_to_go.from(g.vertices.start(), stop).seconds < kForever;
}

Trajectory PlanState::alone(std::size_t robot, const StopCondition& stop) {
  const OccupancyGrid& grid = instance_.problem().grid();
  const ReservationTable nobody(grid.width(), grid.height(), grid.width(),
                                radii(instance_));  // coarse, as it is empty
  Guide& g = guide(robot);
  AaSipp search(nobody);
  SearchResult result = search.run(robot, g.vertices, g.cost_to_go, {}, stop);
  return result.trajectory ? std::move(*result.trajectory) : standing(robot);
}

std::vector<std::size_t> PlanState::conflicting_robots(std::size_t robot,
                                                       const Trajectory& trajectory) const {
  return table_.robots_hit(robot, timed_segments(trajectory));
}

std::vector<std::size_t> PlanState::robots_conflicting_with_standing(std::size_t robot) const {
  return conflicting_robots(robot, standing(robot));
}

}  // namespace fleetplan::core
