#pragma once

#include <chrono>

#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// Met after a share of the time that remains, or when `stop` is cancelled.
inline StopCondition after_share(const StopCondition& stop, double share) {
  using Clock = StopCondition::Clock;
  if (stop.deadline() == Clock::time_point::max()) return stop;
  const auto now = Clock::now();
  const auto remaining = std::chrono::duration_cast<Clock::duration>((stop.deadline() - now) * share);
  return stop.until(now + remaining);
}

}  // namespace fleetplan::core
