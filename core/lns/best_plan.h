#pragma once

#include <cstddef>
#include <map>

#include "core/lns/incumbent.h"
#include "core/model/trajectory.h"

namespace fleetplan::core {

/// The best plan of a search whose incumbent may become worse for a while. Keeps the trajectories in which
/// the two differ.
class BestPlan {
 public:
  /// The incumbent outlives this object, and only this object changes it.
  explicit BestPlan(Incumbent& incumbent) : incumbent_(incumbent) {}

  void replace(std::size_t robot, Trajectory trajectory);
  /// To be called after the replacements of a change: `gain` is by how much the objective fell, seconds;
  /// negative if it rose. Returns whether the incumbent is better than any plan before.
  bool changed(double gain);

  /// The trajectories of the best plan, by robot, where the incumbent may have others.
  const std::map<std::size_t, Trajectory>& differences() const { return differences_; }
  /// Makes the best plan the incumbent.
  void restore();

 private:
  Incumbent& incumbent_;
  std::map<std::size_t, Trajectory> differences_;
  double loss_ = 0.0;  // seconds; of the incumbent against the best plan
};

}  // namespace fleetplan::core
