#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/bounds/taut_path_bounds.h"
#include "core/prioritized/plan_state.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

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
  double most_loss = 0.0;        // weighted seconds, >= 0; by how much the sum may rise
  double cost_limit = kForever;  // seconds; all costs have to be below it
  double min_gain_share = 0.0;   // [0, 1); share of the first robot's delay that it has to gain at least
  SearchLimits limits;           // limits of every search; the bound follows from the other members
};

struct NeighbourhoodResult {
  std::optional<Change> change;
  std::int64_t searches = 0;
  std::int64_t expansions = 0;
};

/// Plans the robots of a neighbourhood again (Li et al., MAPF-LNS, IJCAI 2021): first robots.front() as if
/// the others of `robots` were absent, then those of them that conflict with it, and so on. Trajectories that
/// conflict with further robots of `robots` are accepted only if there is no other. A search ends when no
/// trajectory can bring the required gain any more. All of `robots` have trajectories and bounds. The state
/// is left unchanged.
NeighbourhoodResult plan_neighbourhood(PlanState& state, const std::vector<std::size_t>& robots,
                                       const TautPathBounds& bounds, const NeighbourhoodOptions& options,
                                       const StopCondition& stop);

}  // namespace fleetplan::core
