#pragma once

// What a robot has to do, as far as its policy may not change it.

#include <cstddef>
#include <optional>
#include <vector>

#include "core/execution/simulation/disturbance.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// A part of an action that takes a fixed time: it leads from the end of the part before to this fraction of
/// the action, at constant speed, or the robot stands if that is the same.
struct Phase {
  double seconds = 0.0;
  double to_fraction = 0.0;
};

/// The phases of a rotation or translation, after its start delay: it moves and halts in turn. Returns none
/// if `stop` is met first.
std::optional<std::vector<Phase>> moving_phases(const DisturbedActions& disturbed, std::size_t action,
                                                const StopCondition& stop);

}  // namespace fleetplan::core
