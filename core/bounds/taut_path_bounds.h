#pragma once

#include <cstddef>
#include <map>
#include <vector>

#include "core/instance.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// Lower bounds of the costs of robots, each alone on the static map, seconds: the straight line with its
/// rotations where it is free, the cheapest taut path elsewhere (see TautPathSearch); from goal to goal, with
/// the services, after the committed actions.
class TautPathBounds {
 public:
  /// Of `robots`, all with goals. `costs`, by robot, are those of a known plan; infinite for none. The work
  /// is limited to about half a second: beyond it, on large maps full of corners, or when `stop` is met
  /// or the memory spent, bounds are weaker, down to the straight line.
  TautPathBounds(const Instance& instance, const std::vector<std::size_t>& robots,
                 const std::vector<double>& costs, const StopCondition& stop);

  /// 0 for a robot that was not among `robots`.
  double operator[](std::size_t robot) const { return seconds_[robot]; }
  /// Whether `stop` or a lack of memory weakened a bound.
  bool cut_off() const { return cut_off_; }

 private:
  struct Way;
  struct LegIndex {
    std::size_t robot;
    std::size_t way;
    std::size_t leg;
  };
  using LegsByRadius = std::map<double, std::vector<LegIndex>>;

  void bound(const Instance& instance, const std::vector<std::size_t>& robots,
             const std::vector<double>& costs, const StopCondition& stop);
  /// Replaces the bounds of these legs by those of their taut paths.
  void improve(const Instance& instance, const LegsByRadius& out_of_sight, std::vector<Way>& ways,
               const std::vector<double>& costs, const StopCondition& stop);

  std::vector<double> seconds_;  // by robot
  bool cut_off_ = false;
};

}  // namespace fleetplan::core
