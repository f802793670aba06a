#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "core/fleet/fleet_reservations.h"
#include "core/model/trajectory.h"
#include "core/moves/configuration_search.h"
#include "core/runtime/random.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// Plans robots all at once, in steps in each of which robots move one after the other while all others rest,
/// whatever their lattices, radii, loads, goals and zones are, among the other robots' reservations: first
/// over few places (SparseVertices), then over more of them, in the end over all vertices. Then gives the
/// steps times (times_of_steps). If that fails for what else moves, searches with times (TimedStepSearch).
///
/// Complete for steps over vertices, as far as time and memory last, where nothing else moves: if moves of
/// one robot at a time, each from one vertex to a neighbour while all others rest, lead from the starts to
/// the goals, the search over all vertices reaches the goals, since there are finitely many configurations,
/// and it visits each of those that such moves reach. The times always exist then: a robot that waits until
/// all moves before its own have ended meets nobody.
class PlaceSteps {
 public:
  /// The most robots: each is compared with each other one.
  static constexpr std::size_t kMaxRobots = 256;

  /// `reservations` and `random` outlive this object.
  PlaceSteps(FleetReservations& reservations, std::vector<std::size_t> robots, Random& random);
  ~PlaceSteps();
  PlaceSteps(const PlaceSteps&) = delete;
  PlaceSteps& operator=(const PlaceSteps&) = delete;

  const std::vector<std::size_t>& robots() const { return robots_; }

  /// Goes on with the search until it finds a plan, or `stop` is met. The robots that stay are the same each
  /// time. Returns a trajectory for each of the robots, in their order.
  std::optional<std::vector<Trajectory>> run(const StopCondition& stop);

  /// Whether all configurations were visited that steps over vertices reach.
  bool has_no_way() const { return has_no_way_; }

 private:
  struct Level;

  Level* level(std::size_t number, const StopCondition& stop);
  std::optional<std::vector<Trajectory>> search(Level& level, std::size_t number,
                                                std::size_t max_configurations, const StopCondition& stop);
  std::optional<std::vector<Trajectory>> search_with_times(Level& level, std::size_t max_configurations,
                                                           const StopCondition& stop);
  bool are_few() const;

  FleetReservations& reservations_;
  const std::vector<std::size_t> robots_;
  Random& random_;
  std::vector<std::unique_ptr<Level>> levels_;
  bool has_no_way_ = false;
};

}  // namespace fleetplan::core
