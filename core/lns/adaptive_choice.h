#pragma once

#include <cstddef>
#include <vector>

#include "core/runtime/random.h"

namespace fleetplan::core {

/// Chooses among a few alternatives by their recent gain per effort (adaptive large neighbourhood search;
/// Ropke and Pisinger, 2006). Every alternative keeps a positive probability.
class AdaptiveChoice {
 public:
  /// Of `count` >= 1 alternatives, all equal at first.
  explicit AdaptiveChoice(std::size_t count) : records_(count) {}

  std::size_t choose(Random& random) const;

  /// The gain (>= 0) and effort (> 0) of one try of the alternative, in any units.
  void learn(std::size_t alternative, double gain, double effort);

 private:
  struct Record {  // moving averages over tries
    double gain = 0.0;
    double effort = 0.0;  // 0: not tried yet
  };

  /// Gain per effort.
  double rate(const Record& record) const;
  std::vector<double> weights() const;

  std::vector<Record> records_;
};

}  // namespace fleetplan::core
