#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/compile/instance.h"
#include "core/fleet/fleet_reservations.h"
#include "core/fleet/search_memory.h"
#include "core/fleet/static_ways.h"
#include "core/model/trajectory.h"
#include "core/runtime/stop_condition.h"
#include "core/sipp/aa_sipp.h"

namespace fleetplan::core {

/// Plans one robot among the reservations of the others (paper, section Prioritized planning). It has the
/// reservations, what is known of the ways on the map, and what searches keep.
class PlanState {
 public:
  /// `instance` outlives this object.
  explicit PlanState(const Instance& instance);
  PlanState(const PlanState&) = delete;
  PlanState& operator=(const PlanState&) = delete;

  const Instance& instance() const { return instance_; }
  FleetReservations& reservations() { return reservations_; }
  const FleetReservations& reservations() const { return reservations_; }
  StaticWays& ways() { return ways_; }
  const StaticWays& ways() const { return ways_; }

  /// Plans a robot that has a goal and no reservation. Afterwards, all reservations are as before.
  SearchResult plan(std::size_t robot, const SearchSettings& settings, const StopCondition& stop);
  /// Plans a robot as plan() does, but ignores the reservations of the robots of `ignored`.
  SearchResult plan_ignoring(std::size_t robot, const std::vector<std::size_t>& ignored,
                             const SearchSettings& settings, const StopCondition& stop);
  /// Plans a robot as plan() does, but does not ask during the search whether robots that stay close it off.
  /// For callers that change which reservations the search sees.
  SearchResult search(std::size_t robot, const SearchSettings& settings, const StopCondition& stop);
  /// Plans a robot as plan() does, to these goals instead of its own goals. The robot has one load.
  SearchResult plan_to(std::size_t robot, std::vector<Goal> goals, const SearchSettings& settings,
                       const StopCondition& stop);
  /// Plans a robot that follows a trajectory again, as plan() does, among the other robots. If there is a
  /// trajectory, the robot follows it instead.
  SearchResult replan(std::size_t robot, const SearchSettings& settings, const StopCondition& stop);
  /// The trajectory of the robot alone on the map; it stays in its place if there is none.
  Trajectory plan_alone(std::size_t robot, const StopCondition& stop);

  /// With a horizon: from now on, this robot is planned to its goals, beyond the horizon. It is planned past
  /// all robots that have arrived and are not planned yet; these stay in their places meanwhile. It arrives
  /// no later than by its previous plan, if possible. When a search finds no such way, it searches up to the
  /// horizon, and so do all later searches.
  void set_whole_way_of(std::size_t robot) { whole_way_of_ = robot; }
  /// Also none if the robot has no such way.
  const std::optional<std::size_t>& whole_way_of() const { return whole_way_of_; }

  /// What searches keep for later.
  SearchMemory& memory() { return memory_; }

  /// Expansions of all searches among reservations so far.
  std::int64_t expansions() const { return expansions_; }

 private:
  SearchResult search_until(double horizon, std::size_t robot, const SearchSettings& settings,
                            const StopCondition& stop);
  SearchResult search_whole_way(std::size_t robot, const SearchSettings& settings, const StopCondition& stop);
  std::vector<std::size_t> arrived_without_plan(std::size_t except) const;
  bool goal_stays_free(std::size_t robot) const;

  const Instance& instance_;
  FleetReservations reservations_;
  SearchMemory memory_;
  StaticWays ways_;
  std::optional<std::size_t> whole_way_of_;
  std::int64_t expansions_ = 0;
};

}  // namespace fleetplan::core
