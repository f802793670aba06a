#pragma once

#include <cstddef>
#include <vector>

#include "core/runtime/random.h"

namespace fleetplan::core {

/// Chooses which robot is to become better: more likely the more delayed it is, and the less often it was
/// tried in vain lately.
class DelayedChoice {
 public:
  /// Among robots 0 to count - 1, none tried yet.
  explicit DelayedChoice(std::size_t count) : failures_(count, 0.0) {}

  /// One of `robots`, with delays[k] >= 0 seconds that of robots[k]; not empty.
  std::size_t choose(const std::vector<std::size_t>& robots, const std::vector<double>& delays,
                     Random& random) const;

  /// What came of trying the robot.
  void learn(std::size_t robot, bool gained);

 private:
  std::vector<double> failures_;  // by robot, those before a gain counting less
};

}  // namespace fleetplan::core
