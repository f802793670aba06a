#include "core/fleet/static_ways.h"

#include <algorithm>
#include <utility>

#include "core/fleet/enclosure.h"
#include "core/sipp/goals.h"

namespace fleetplan::core {
namespace {

/// Steps of Enclosure for each expansion of a search on the map, which takes five times as long.
constexpr std::int64_t kEnclosureSteps = 2;
/// Steps of Enclosure for a way that the lattice misses: about 2 ms.
constexpr std::int64_t kOffLatticeSteps = 50'000;
/// A lattice has every way that is wider than the robot by this many spacings.
constexpr double kWidestCells = 3.0;
/// Expansions of a search on the map before Enclosure is asked.
constexpr std::int64_t kFirstExpansions = 16'384;
/// Goals of a robot between two checks of the stop condition.
constexpr std::size_t kGoalsBetweenPolls = 16;

}  // namespace

StaticWays::StaticWays(const FleetReservations& reservations, SearchMemory& memory)
    : reservations_(reservations),
      memory_(memory),
      instance_(reservations.instance()),
      ways_(instance_.size()) {}

bool StaticWays::can_leave_place(std::size_t robot, const StopCondition& stop) {
  return memory_.within_memory(true, [&] {
    SearchSpace* space = memory_.space_of(robot, stop);
    if (space == nullptr) return true;
    const Vertices& vertices = space->vertices();
    bool can_leave = false;
    vertices.for_each_neighbour(vertices.start(), [&](int) { can_leave = true; });
    return can_leave;
  });
}

bool StaticWays::can_enter_last_goal(std::size_t robot, const StopCondition& stop) {
  return memory_.within_memory(true, [&] {
    SearchSpace* space = memory_.space_of(robot, stop);
    if (space == nullptr) return true;
    const std::size_t last = space->goal_count() - 1;
    const Vertices& vertices = space->vertices(last);
    const int goal = space->goal_pose(last).vertex;
    bool can_enter = goal == space->begin_of(last);
    vertices.for_each_neighbour(goal, [&](int) { can_enter = true; });
    return can_enter;
  });
}

const Way& StaticWays::way_to_goal(std::size_t robot, std::int64_t max_expansions,
                                   const StopCondition& stop) {
  Way& way = ways_[robot];
  if (way.kind != Way::Kind::unknown) return way;
  memory_.within_memory(false, [&] {
    find_way(robot, max_expansions, stop);
    return true;
  });
  return way;
}

void StaticWays::find_way(std::size_t robot, std::int64_t max_expansions, const StopCondition& stop) {
  SearchSpace* space = memory_.space_of(robot, stop);
  if (space == nullptr) return;
  std::int64_t left = max_expansions;
  StopStride stride(stop, kGoalsBetweenPolls);
  for (std::size_t goal = 0; goal < space->goal_count(); ++goal) {
    ways_[robot] = {};
    if (stride.met_at_step()) break;
    left -= find_leg(robot, *space, goal, left, stop);
    if (ways_[robot].kind != Way::Kind::on_lattice) break;
  }
  map_expansions_ += max_expansions - left;
}

/// The way to a goal from the one before, or from where the plan begins. Returns the expansions.
std::int64_t StaticWays::find_leg(std::size_t robot, SearchSpace& space, std::size_t goal,
                                  std::int64_t max_expansions, const StopCondition& stop) {
  Way& way = ways_[robot];
  const int from = space.begin_of(goal);
  if (from == space.goal_pose(goal).vertex) {
    way.kind = Way::Kind::on_lattice;
    return 0;
  }
  CostToGo& costs = space.cost_to_go(goal);
  const std::int64_t before = costs.expansions();
  std::int64_t last = 0;
  for (std::int64_t next = kFirstExpansions; way.kind == Way::Kind::unknown && last < max_expansions;) {
    const std::int64_t count = std::min(next, max_expansions) - last;
    const auto reaches = costs.reaches(from, count, stop);
    last += count;
    next *= 2;
    if (reaches && *reaches) way.kind = Way::Kind::on_lattice;
    if (reaches && !*reaches) {
      way = space.goal_count() == 1 ? way_off_lattice(robot, stop) : Way{Way::Kind::not_on_lattice, {}, {}};
    }
    if (reaches || stop.met()) break;
    // With a horizon, a robot that others close off may come nearer to its goal all the same.
    test_enclosure(robot, instance_.options().horizon ? Robots() : others_that_stay(robot), last, stop);
  }
  return costs.expansions() - before;
}

/// For a robot without a way on the lattice: whether obstacles close off its goal on any lattice.
Way StaticWays::way_off_lattice(std::size_t robot, const StopCondition& stop) const {
  Enclosure enclosure(instance_, robot, {}, stop);
  if (enclosure.find(kOffLatticeSteps).answer == Enclosure::Answer::closed)
    return {Way::Kind::closed, {}, {}};
  const double limit =
      2.0 * instance_.body(robot).wall_radius + kWidestCells * instance_.lattice(robot).spacing();
  return {Way::Kind::not_on_lattice, {}, enclosure.widest_way(limit, kOffLatticeSteps)};
}

bool StaticWays::is_closed_off(std::size_t robot, std::int64_t expansions, const StopCondition& stop) {
  return test_enclosure(robot, others_that_stay(robot), expansions, stop);
}

StaticWays::Robots StaticWays::others_that_stay(std::size_t robot) const {
  Robots staying = reservations_.staying_robots();
  std::erase(staying, robot);
  return staying;
}

/// Whether obstacles and these robots are found to close off the robot; see is_closed_off().
bool StaticWays::test_enclosure(std::size_t robot, const Robots& staying, std::int64_t expansions,
                                const StopCondition& stop) {
  Enclosure::Result result = Enclosure(instance_, robot, staying, stop).find(kEnclosureSteps * expansions);
  if (result.answer != Enclosure::Answer::closed) return false;
  if (!result.robots.empty()) closed_by_robots_.push_back(robot);
  ways_[robot] = {Way::Kind::closed, std::move(result.robots), {}};
  return true;
}

bool StaticWays::takes_too_long(std::size_t robot, const StopCondition& stop) {
  return memory_.within_memory(false, [&] {
    SearchSpace* space = memory_.space_of(robot, stop);
    const auto end = space != nullptr ? estimated_end(*space, stop) : std::nullopt;
    return end && *end >= instance_.views(robot).longest_plan();
  });
}

double StaticWays::estimated_alone(std::size_t robot, const StopCondition& stop) {
  return memory_.within_memory(kForever, [&] {
    SearchSpace* space = memory_.space_of(robot, stop);
    const auto end = space != nullptr ? estimated_end(*space, stop) : std::nullopt;
    return end && *end > 0.0 ? *end : kForever;
  });
}

void StaticWays::forget_closed_by_robots(std::optional<std::size_t> left) {
  const auto forget = [&](std::size_t robot) { return robot != left; };
  for (const std::size_t robot : closed_by_robots_) {
    if (forget(robot)) ways_[robot] = {};
  }
  std::erase_if(closed_by_robots_, forget);
}

void StaticWays::forget_if_closed_by_robots(std::size_t robot) {
  if (std::erase(closed_by_robots_, robot) > 0) ways_[robot] = {};
}

void StaticWays::forget_if_closed_by(const std::vector<std::size_t>& others, std::size_t robot) {
  const std::vector<std::size_t>& closed_by = ways_[robot].closed_by;
  const auto found = std::find_first_of(closed_by.begin(), closed_by.end(), others.begin(), others.end());
  if (found != closed_by.end()) forget_if_closed_by_robots(robot);
}

}  // namespace fleetplan::core
