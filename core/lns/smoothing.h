#pragma once

// Makes paths shorter without a search, by bends that leave the lattice.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/fleet/plan_state.h"
#include "core/fleet/progress_report.h"
#include "core/model/plan_options.h"
#include "core/model/trajectory.h"
#include "core/runtime/random.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// Whether paths may leave the lattice, and end at goals.
inline bool may_smooth(const PlanOptions& options) {
  return options.smoothing && options.any_angle && !options.horizon;
}

struct Smoothed {
  std::optional<Trajectory> trajectory;  // none if nothing was gained
  std::int64_t timed = 0;                // paths that were timed, see TimedPath
};

/// Moves, removes and inserts bends of the robot's path, at random, `tries` times. Keeps changes that reduce
/// its share in the objective (see share_of()). Waits become shorter as well where other robots leave time.
///
/// The trajectory passes all other robots; a reservation of the robot itself is left out. Paths that
/// TimedPath does not take stay as they are. The state is left unchanged.
Smoothed smooth(PlanState& state, std::size_t robot, const Trajectory& trajectory, int tries, Random& random,
                const StopCondition& stop);

/// Smooths the new trajectories of these robots briefly, one after the other, in a share of the time that is
/// left. Counts them in `progress`. Returns whether it ended early.
bool smooth_briefly(PlanState& state, std::vector<std::size_t> robots, Random& random,
                    const StopCondition& stop, ProgressReport& progress);

}  // namespace fleetplan::core
