#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// A dependency by whole progress: robot `waits` may not pass `gate` until robot `leads` has reached `until`.
struct WholeDependency {
  std::size_t waits = 0;
  std::size_t leads = 0;
  double gate = 0.0;
  double until = 0.0;
  double t_until = 0.0;  // the planned time of `until`, seconds
};

/// Those that no two others imply. A waits for C if A waits for B, which must first pass a gate of its own to
/// C: the progress of B that A waits for is strictly beyond that gate. `all`: of each pair of robots in
/// ascending order of both progresses. Nothing if the stop condition is met.
std::optional<std::vector<WholeDependency>> without_implied(std::vector<WholeDependency> all,
                                                            const StopCondition& stop);

}  // namespace fleetplan::core
