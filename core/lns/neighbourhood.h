#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/prioritized/plan_state.h"
#include "core/runtime/random.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// Which robots go together with one that is to become better.
enum class Neighbourhood : std::uint8_t {
  conflicting,  // of the path it would take alone, and those in the way of these in turn
  meeting,      // nearest to where it is at a random time
  at_goal,      // whose paths lead near its goal
  anybody,
};
inline constexpr std::size_t kNeighbourhoods = 4;

/// Chooses robots to be planned together (destroy heuristics of MAPF-LNS; Li et al., IJCAI 2021).
class Neighbourhoods {
 public:
  /// Among the robots of `planned`, which have trajectories.
  Neighbourhoods(PlanState& state, std::vector<std::size_t> planned, const StopCondition& stop)
      : state_(state), planned_(std::move(planned)), stop_(stop), alone_(state.instance().size()) {}

  /// `first` and at most size - 1 others (size >= 1).
  std::vector<std::size_t> around(std::size_t first, Neighbourhood kind, std::size_t size, Random& random);

 private:
  void add_those_in_the_way(std::vector<std::size_t>& chosen, std::size_t size, Random& random);
  void add_nearest(std::vector<std::size_t>& chosen, std::size_t size, std::vector<double> distances) const;
  std::vector<double> distances_at(double time, std::size_t first) const;
  std::vector<double> distances_to_goal(std::size_t first, Random& random) const;
  const Trajectory& alone(std::size_t robot);

  PlanState& state_;
  std::vector<std::size_t> planned_;
  const StopCondition& stop_;
  std::vector<std::optional<Trajectory>> alone_;  // by robot, computed when first asked for
};

}  // namespace fleetplan::core
