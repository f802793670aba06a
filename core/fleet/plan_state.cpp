#include "core/fleet/plan_state.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "core/runtime/memory_account.h"

namespace fleetplan::core {
namespace {

/// Seconds: a way that ends later by less is no later than by the previous plan; far above rounding.
constexpr double kNoLater = 1e-6;

/// Ends a search when obstacles and robots that stay are found to close off the robot.
class EnclosureTest final : public NoPathTest {
 public:
  EnclosureTest(StaticWays& ways, std::size_t robot, const StopCondition& stop)
      : ways_(ways), robot_(robot), stop_(stop) {}
  bool no_path(std::int64_t expansions) override { return ways_.is_closed_off(robot_, expansions, stop_); }

 private:
  StaticWays& ways_;
  std::size_t robot_;
  const StopCondition& stop_;
};

}  // namespace

PlanState::PlanState(const Instance& instance)
    : instance_(instance),
      reservations_(instance,
                    [this](std::optional<std::size_t> robot) { ways_.forget_closed_by_robots(robot); }),
      memory_(instance, reservations_.table()),
      ways_(reservations_, memory_) {}

SearchResult PlanState::plan(std::size_t robot, const SearchSettings& settings, const StopCondition& stop) {
  EnclosureTest test(ways_, robot, stop);
  SearchSettings with_test = settings;
  // With a horizon, a robot that is closed off may come nearer to its goal all the same.
  if (reservations_.any_stays() && !instance_.options().horizon) with_test.no_path_test = &test;
  return search(robot, with_test, stop);
}

SearchResult PlanState::plan_ignoring(std::size_t robot, const std::vector<std::size_t>& ignored,
                                      const SearchSettings& settings, const StopCondition& stop) {
  ways_.forget_if_closed_by(ignored, robot);
  const IgnoredRobots without(reservations_, ignored);
  return plan(robot, settings, stop);
}

SearchResult PlanState::plan_to(std::size_t robot, std::vector<Goal> goals, const SearchSettings& settings,
                                const StopCondition& stop) {
  SearchResult result = memory_.within_memory(SearchResult{std::nullopt, false, 0}, [&]() -> SearchResult {
    Itinerary itinerary = instance_.itinerary(robot);
    itinerary.goals = std::move(goals);
    SearchSpace space(instance_, robot, std::move(itinerary), stop);
    if (!space.finished()) return {std::nullopt, false, 0};
    SearchSettings within = settings;
    within.bound = std::min(settings.bound, instance_.views(robot).longest_plan());
    return memory_.search().run(space, within, stop);
  });
  expansions_ += result.expansions;
  return result;
}

SearchResult PlanState::replan(std::size_t robot, const SearchSettings& settings, const StopCondition& stop) {
  Trajectory now = *reservations_.trajectory(robot);
  reservations_.remove(robot);
  SearchResult result = plan(robot, settings, stop);
  reservations_.follow(robot, result.trajectory ? *result.trajectory : std::move(now));
  return result;
}

SearchResult PlanState::search(std::size_t robot, const SearchSettings& settings, const StopCondition& stop) {
  if (robot == whole_way_of_) {
    SearchResult whole = search_whole_way(robot, settings, stop);
    if (whole.trajectory) return whole;
    whole_way_of_.reset();
  }
  return search_until(instance_.options().horizon.value_or(kForever), robot, settings, stop);
}

/// Searches up to the horizon, seconds (kForever: to the goal); twice if the first time lacks memory.
SearchResult PlanState::search_until(double horizon, std::size_t robot, const SearchSettings& settings,
                                     const StopCondition& stop) {
  if (horizon == kForever && !goal_stays_free(robot)) return {};
  constexpr auto no_memory = [] { return SearchResult{std::nullopt, false, 0}; };
  const auto search_once = [&]() -> SearchResult {
    constexpr auto kAnyNumber = std::numeric_limits<std::int64_t>::max();
    const Way& way = ways_.way_to_goal(robot, kAnyNumber, stop);
    if (way.kind == Way::Kind::unknown) return no_memory();
    if (way.none()) return {};
    SearchSpace* space = memory_.space_of(robot, stop);
    if (space == nullptr) return no_memory();
    SearchSettings within = settings;
    within.bound = std::min(settings.bound, instance_.views(robot).longest_plan());
    within.horizon = horizon;
    return memory_.search().run(*space, within, stop);
  };
  const std::int64_t shortages = memory_shortages();
  SearchResult result = memory_.within_memory(no_memory(), search_once);
  // What was kept of other searches is discarded by now, which may leave enough for this one.
  const bool lacked_memory = !result.trajectory && !result.complete && memory_shortages() > shortages;
  if (lacked_memory && !stop.met()) result = memory_.within_memory(no_memory(), search_once);
  expansions_ += result.expansions;
  return result;
}

/// Whether the robot may rest at its goal from some time on: if not, a search need not be prepared.
bool PlanState::goal_stays_free(std::size_t robot) const {
  if (instance_.itinerary(robot).yields()) return true;
  const std::size_t at_rest = instance_.itinerary(robot).goals.size();
  const Footprint footprint{robot, instance_.views(robot)[at_rest].body.radius};
  const auto safe =
      reservations_.table().safe_intervals(footprint, instance_.itinerary(robot).last_goal().position);
  return !safe.empty() && safe.back().end == kForever;
}

/// Robots with nothing to do may make way for others, or may be unable to. A robot that waits before such a
/// robot would wait for ever, although there is another way. So they stay in their places during this search.
SearchResult PlanState::search_whole_way(std::size_t robot, const SearchSettings& settings,
                                         const StopCondition& stop) {
  const std::vector<std::size_t> arrived = arrived_without_plan(robot);
  std::vector<double> held_for;
  for (const std::size_t other : arrived) {
    held_for.push_back(reservations_.holds_place_for(other));
    reservations_.stay_in_place(other);
  }
  EnclosureTest test(ways_, robot, stop);
  SearchSettings with_test = settings;
  with_test.no_path_test = &test;
  with_test.bound = std::min(settings.bound, instance_.previous_end(robot) + kNoLater);
  SearchResult result = search_until(kForever, robot, with_test, stop);
  if (!result.trajectory && with_test.bound < settings.bound) {
    with_test.bound = settings.bound;
    result = search_until(kForever, robot, with_test, stop);
  }
  for (std::size_t k = 0; k < arrived.size(); ++k) reservations_.reserve_place(arrived[k], held_for[k]);
  ways_.forget_if_closed_by_robots(robot);  // they may make way
  return result;
}

/// The robots that stand at their goals and have no plan yet, except this robot.
std::vector<std::size_t> PlanState::arrived_without_plan(std::size_t except) const {
  std::vector<std::size_t> arrived;
  for (std::size_t other = 0; other < instance_.size(); ++other) {
    const Itinerary& itinerary = instance_.itinerary(other);
    const bool has_place = reservations_.trajectory(other) || reservations_.stays(other);
    if (other == except || itinerary.is_parked() || has_place) continue;
    if (has_arrived(itinerary)) arrived.push_back(other);
  }
  return arrived;
}

Trajectory PlanState::plan_alone(std::size_t robot, const StopCondition& stop) {
  const OccupancyGrid& grid = instance_.problem().grid();
  const double cell_size = grid.width();  // coarse, as the table stays empty
  const ReservationTable empty(grid.width(), grid.height(), cell_size, largest_disks(instance_));
  SearchResult result = memory_.within_memory(SearchResult(), [&]() -> SearchResult {
    SearchSpace* space = memory_.space_of(robot, stop);
    if (space == nullptr) return {};
    AaSipp search(empty);
    return search.run(*space, {.horizon = instance_.options().horizon.value_or(kForever)}, stop);
  });
  return result.trajectory ? std::move(*result.trajectory) : instance_.itinerary(robot).committed;
}

}  // namespace fleetplan::core
