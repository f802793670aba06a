#pragma once

// Robots that pass the same place with less than the interval margin between them.

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "core/runtime/stop_condition.h"
#include "core/verify/execution.h"
#include "core/verify/geometry/relative_motion.h"

namespace fleetplan::core {

/// An overlap, by more than the tolerance, of two robots (positions in the fleet, first < second) at
/// different times.
struct ShiftedOverlap {
  std::size_t first = 0;
  std::size_t second = 0;
  double t_first = 0.0;
  double t_second = 0.0;
  double distance = 0.0;  // metres, between the centres
};

/// Returns the times of a pair that the margin leaves out: no time of either robot lies in one of them.
using LeftOut = std::function<std::vector<TimeSpan>(std::size_t first, std::size_t second)>;

/// Returns the deepest overlap within the margin of each pair, in the order of the pairs, at most `most`.
/// Times differ by `margin` or less. Left out are times at which both robots execute commitments or one of
/// them stays at the end of its commitment before it first leaves. All radii are enlarged by `inflation` and
/// the vicinity. Returns none if `stop` is met first.
std::optional<std::vector<ShiftedOverlap>> overlaps_within_margin(const ExecutedFleet& fleet, double margin,
                                                                  double inflation, const LeftOut& left_out,
                                                                  std::size_t most,
                                                                  const StopCondition& stop);

}  // namespace fleetplan::core
