#pragma once

// The robots that an iteration of large neighbourhood search plans again together: how they are selected, and
// how they are planned.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/bounds/taut_path_bounds.h"
#include "core/fleet/plan_state.h"
#include "core/runtime/random.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// How to select the robots that are planned again together with a delayed robot.
enum class Neighbourhood : std::uint8_t {
  conflicting,  // robots that conflict with the robot's path alone on the map; then robots that conflict with
                // such paths of these robots
  nearest,      // robots nearest to it at a random time
  at_goal,      // robots that pass near its goal
  random,
};
inline constexpr std::size_t kNeighbourhoods = 4;

/// Selects the robots that large neighbourhood search plans again together (Li et al., MAPF-LNS, IJCAI 2021).
class NeighbourhoodSelection {
 public:
  /// Selects from the robots of `planned`, which have trajectories.
  NeighbourhoodSelection(PlanState& state, std::vector<std::size_t> planned, const StopCondition& stop)
      : state_(state),
        planned_(std::move(planned)),
        is_planned_(state.instance().size(), false),
        stop_(stop),
        trajectories_alone_(state.instance().size()) {
    for (const std::size_t robot : planned_) is_planned_[robot] = true;
  }

  /// Returns `first` and at most size - 1 other robots (size >= 1).
  std::vector<std::size_t> select(std::size_t first, Neighbourhood kind, std::size_t size, Random& random);

 private:
  std::vector<std::size_t> conflicting_with(std::size_t first, std::size_t size, Random& random);
  std::vector<std::size_t> nearest_to(std::size_t first, std::size_t size,
                                      const std::vector<double>& distances) const;
  std::vector<std::size_t> random_with(std::size_t first, std::size_t size, Random& random) const;
  std::vector<double> distances_at(double time, std::size_t first) const;
  std::vector<double> distances_to_goal(std::size_t first, Random& random) const;
  const Trajectory& trajectory_alone(std::size_t robot);

  PlanState& state_;
  std::vector<std::size_t> planned_;
  std::vector<bool> is_planned_;  // by robot
  const StopCondition& stop_;
  std::vector<std::optional<Trajectory>> trajectories_alone_;  // by robot, computed on first use
};

/// New trajectories of some robots, free of conflicts with each other and with all other robots.
struct Change {
  struct Part {
    std::size_t robot = 0;
    Trajectory trajectory;
  };
  std::vector<Part> parts;
  double gain = 0.0;  // weighted seconds, see NeighbourhoodOptions::Gain
};

/// Which changes of a neighbourhood are accepted, and the effort for them.
struct NeighbourhoodOptions {
  enum class Gain : std::uint8_t {
    sum,    // the sum of the shares in the objective (see share_of()) has to fall
    first,  // the share of the first robot has to fall, whatever the others' become
  };
  Gain gain = Gain::sum;
  double max_loss = 0.0;         // weighted seconds, >= 0; by how much the sum may rise
  double cost_limit = kForever;  // seconds; all costs have to be below it
  double min_gain_share = 0.0;   // [0, 1); share of the first robot's delay that it has to gain at least
  /// Limits of every search. The bound follows from the other members. None: only the first robot's path is
  /// smoothed.
  std::optional<SearchSettings> settings = SearchSettings();
  int tries = 100;  // to smooth each path
};

struct NeighbourhoodResult {
  std::optional<Change> change;
  std::int64_t expansions = 0;
  double effort = 0.0;  // in expansions, of searches and smoothing
};

/// Plans the robots of a neighbourhood again (Li et al., MAPF-LNS, IJCAI 2021). First robots.front() is
/// planned as if the other `robots` were absent, then the robots that conflict with it, and so on.
/// Trajectories that conflict with further robots of `robots` are accepted only if there is no other
/// trajectory.
///
/// Trajectories that are found are smoothed. So a search ends when no trajectory can reach the required gain
/// any more, even if it is smoothed as much as the robot's was. All of `robots` have trajectories and bounds.
/// The state is left unchanged.
NeighbourhoodResult plan_neighbourhood(PlanState& state, const std::vector<std::size_t>& robots,
                                       const TautPathBounds& bounds, const NeighbourhoodOptions& options,
                                       Random& random, const StopCondition& stop);

}  // namespace fleetplan::core
