#pragma once

#include <cstddef>
#include <vector>

#include "core/instance.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// For robots each alone on the static map, what no plan of theirs can cost less than, seconds: the straight
/// line and the turns where that is free, the cheapest taut path elsewhere (see TautSearch).
class TautBounds {
 public:
  /// Of `robots`, all with goals; `costs`, by robot: of a plan that is known, infinite for none. Where that
  /// would take more than about half a second, on large maps full of corners, or when `stop` is met, bounds
  /// are weaker, down to the straight line.
  TautBounds(const Instance& instance, const std::vector<std::size_t>& robots,
             const std::vector<double>& costs, const StopCondition& stop);

  /// 0 for a robot that was not among `robots`.
  double operator[](std::size_t robot) const { return seconds_[robot]; }
  /// Did `stop` weaken a bound?
  bool cut_off() const { return cut_off_; }

 private:
  std::vector<double> seconds_;
  bool cut_off_ = false;
};

}  // namespace fleetplan::core
