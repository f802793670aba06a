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

/// Plans robots all at once, in steps, among the reservations of the other robots. In each step, robots move
/// one after the other while all others rest. Their lattices, radii, loads, goals and zones may differ.
///
/// 1. Plans over few places (SparseVertices), then over more of them, and in the end over all vertices.
/// 2. Gives the steps times (times_of_steps).
/// 3. If other moving things prevent this, searches with times (TimedStepSearch).
///
/// Complete for steps over vertices where nothing else moves, as far as time and memory last. Suppose that
/// moves of one robot at a time lead from the starts to the goals, each from one vertex to a neighbour. Then
/// the search over all vertices reaches the goals: there are finitely many configurations, and it visits
/// every configuration that such moves reach. The times always exist then: a robot that waits until all
/// earlier moves have ended meets no robot.
class PlaceSteps {
 public:
  /// The most robots, because all pairs are compared.
  static constexpr std::size_t kMaxRobots = 256;

  /// `reservations` and `random` outlive this object.
  PlaceSteps(FleetReservations& reservations, std::vector<std::size_t> robots, Random& random);
  ~PlaceSteps();
  PlaceSteps(const PlaceSteps&) = delete;
  PlaceSteps& operator=(const PlaceSteps&) = delete;

  const std::vector<std::size_t>& robots() const { return robots_; }

  /// Continues the search until it finds a plan or `stop` is met. The robots that stay must be the same each
  /// time. Returns a trajectory for each of the robots, in their order.
  std::optional<std::vector<Trajectory>> run(const StopCondition& stop);

  /// Whether every configuration that steps over vertices reach has been visited.
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
