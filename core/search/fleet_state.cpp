#include "core/search/fleet_state.h"

#include <utility>

namespace fleetplan::core {
namespace {

/// Memory for the robots' costs-to-go; beyond it they are computed again.
constexpr std::size_t kMaxGuideBytes = std::size_t{384} << 20;

std::vector<double> radii(const Fleet& fleet) {
  std::vector<double> radii;
  radii.reserve(fleet.size());
  for (std::size_t i = 0; i < fleet.size(); ++i) radii.push_back(fleet.motion(i).radius);
  return radii;
}

}  // namespace

FleetState::FleetState(const Fleet& fleet)
    : fleet_(fleet),
      table_(fleet.problem().grid().width(), fleet.problem().grid().height(),
             fleet.problem().grid().resolution(), radii(fleet)),
      search_(fleet, table_),
      trajectories_(fleet.size()),
      guides_(fleet.size()) {}

Trajectory FleetState::standing(std::size_t robot) const {
  return {fleet_.robot(robot).start.position, {}, 0.0};
}

void FleetState::reserve(std::size_t robot, const std::vector<TimedSegment>& segments) {
  leave(robot);
  table_.commit(robot, segments);
}

void FleetState::leave(std::size_t robot) {
  table_.remove(robot);
  if (trajectories_[robot]) --following_;
  trajectories_[robot].reset();
}

void FleetState::follow(std::size_t robot, Trajectory trajectory) {
  reserve(robot, timed_segments(trajectory));
  trajectories_[robot] = std::move(trajectory);
  ++following_;
}

void FleetState::stand_for_ever(std::size_t robot) { reserve(robot, timed_segments(standing(robot))); }

void FleetState::block_start(std::size_t robot, double seconds) {
  const Position start = fleet_.robot(robot).start.position;
  leave(robot);
  if (seconds > 0.0) table_.commit(robot, {{{start, start}, 0.0, seconds}});
}

FleetState::Guide& FleetState::guide(std::size_t robot) {
  if (!guides_[robot]) {
    forget_other_guides(robot);
    guides_[robot] = std::make_unique<Guide>(fleet_, robot);
  }
  return *guides_[robot];
}

void FleetState::forget_other_guides(std::size_t robot) {
  std::size_t bytes = 0;
  for (const auto& guide : guides_) bytes += guide ? guide->cost_to_go.bytes() : 0;
  if (bytes < kMaxGuideBytes) return;
  for (std::size_t i = 0; i < guides_.size(); ++i) {
    if (i != robot) guides_[i].reset();
  }
}

SearchResult FleetState::plan(std::size_t robot, const SearchLimits& limits, const StopCondition& stop) {
  Guide& g = guide(robot);
  SearchResult result = search_.run(robot, g.vertices, g.cost_to_go, limits, stop);
  expansions_ += result.expansions;
  return result;
}

SearchResult FleetState::plan_ignoring(const std::vector<std::size_t>& ignored, std::size_t robot,
                                       const SearchLimits& limits, const StopCondition& stop) {
  for (const std::size_t other : ignored) table_.ignore(other, true);
  SearchResult result = plan(robot, limits, stop);
  for (const std::size_t other : ignored) table_.ignore(other, false);
  return result;
}

bool FleetState::goal_reachable(std::size_t robot, const StopCondition& stop) {
  if (stop.met()) return true;  // not known
  Guide& g = guide(robot);
  return g.vertices.start() == g.vertices.goal() ||
         g.cost_to_go.from(g.vertices.start(), stop).seconds < kForever;
}

Trajectory FleetState::alone(std::size_t robot, const StopCondition& stop) {
  const OccupancyGrid& grid = fleet_.problem().grid();
  const ReservationTable nobody(grid.width(), grid.height(), grid.width(),
                                radii(fleet_));  // coarse, as it is empty
  Guide& g = guide(robot);
  AaSipp search(fleet_, nobody);
  SearchResult result = search.run(robot, g.vertices, g.cost_to_go, {}, stop);
  return result.trajectory ? std::move(*result.trajectory) : standing(robot);
}

std::vector<std::size_t> FleetState::in_the_way(std::size_t robot, const Trajectory& trajectory) const {
  return table_.robots_hit(robot, timed_segments(trajectory));
}

std::vector<std::size_t> FleetState::in_the_way_of_standing(std::size_t robot) const {
  return in_the_way(robot, standing(robot));
}

}  // namespace fleetplan::core
