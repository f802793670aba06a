#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "core/execution/near_stretches.h"
#include "core/execution/staircase.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// What two robots ask of each other.
struct PairDependencies {
  std::vector<Step> for_second;  // the second robot waits for the first
  std::vector<Step> for_first;
  std::vector<Tightness> tight;
};

/// One of two robots: its motion in stretches, and when it is planned.
struct PacedRobot {
  const std::vector<PlannedStretch>& stretches;
  const Pace& pace;
};

/// `near`: stretches of the first robot (NearPair::other_stretch) near those of the second. `tolerance`
/// (metres) is subtracted from the sum of the radii. Nothing if the stop condition is met.
std::optional<PairDependencies> pair_dependencies(const PacedRobot& first, const PacedRobot& second,
                                                  std::span<const NearPair> near, double tolerance,
                                                  double slack, const StopCondition& stop);

}  // namespace fleetplan::core
