#pragma once

#include <cstddef>
#include <vector>

#include "core/runtime/random.h"

namespace fleetplan::core {

/// Chooses the robot whose cost an iteration tries to reduce: with a probability that grows with its delay
/// (cost minus lower bound) and falls with its recent failures.
class DelayedChoice {
 public:
  /// For robots 0 to count - 1.
  explicit DelayedChoice(std::size_t count) : failures_(count, 0.0) {}

  /// Returns one of `robots` (not empty); delays[k] >= 0 is the delay of robots[k] in seconds.
  std::size_t choose(const std::vector<std::size_t>& robots, const std::vector<double>& delays,
                     Random& random) const;

  /// Whether an iteration made the robot cheaper.
  void learn(std::size_t robot, bool gained);

 private:
  std::vector<double> failures_;  // by robot; failures before a gain count less
};

}  // namespace fleetplan::core
