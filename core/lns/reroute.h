#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/bounds/taut_bounds.h"
#include "core/prioritized/plan_state.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// New trajectories of some robots, clear of one another and of everybody else.
struct Change {
  struct Part {
    std::size_t robot = 0;
    Trajectory trajectory;
  };
  std::vector<Part> parts;
  double gain = 0.0;  // seconds, see Aim
};

/// What a change has to achieve.
struct Aim {
  enum class Gain : std::uint8_t {
    sum,    // of all costs; it falls
    first,  // the first robot's cost falls, whatever the others'
  };
  Gain gain = Gain::sum;
  double ceiling = kForever;  // seconds; all costs must be below it
  double ambition = 0.0;      // [0, 1); the share of its delay that the first robot has to lose at least
  SearchLimits limits;        // for every search; the bound follows from the rest
};

struct Rerouting {
  std::optional<Change> change;
  std::int64_t searches = 0;
  std::int64_t expansions = 0;
};

/// Looks for a change that makes robots.front() cheaper: plans it as if the others of `robots` were not
/// there, then those of them that it hits. These hit others in turn only if there is no other way for them.
/// Each may lose only so much that the aim stays in reach. All of `robots` have trajectories and bounds. The
/// state is afterwards as it was.
Rerouting reroute(PlanState& state, const std::vector<std::size_t>& robots, const TautBounds& bounds,
                  const Aim& aim, const StopCondition& stop);

}  // namespace fleetplan::core
