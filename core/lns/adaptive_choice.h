#pragma once

#include <cstddef>
#include <vector>

#include "core/runtime/random.h"

namespace fleetplan::core {

/// Chooses among a few ways of doing something by what each gained lately for its effort (adaptive large
/// neighbourhood search; Ropke and Pisinger, 2006), so that effort goes where it pays; none is ever
/// forgotten.
class AdaptiveChoice {
 public:
  /// Among `count` >= 1 ways, all equally good so far.
  explicit AdaptiveChoice(std::size_t count) : records_(count) {}

  std::size_t choose(Random& random) const;

  /// What `way` gained (>= 0) at what effort (> 0), in any units.
  void learn(std::size_t way, double gain, double effort);

 private:
  struct Record {
    double gain = 0.0;    // moving averages of one try
    double effort = 0.0;  // 0: not tried yet
  };

  /// Gain per effort.
  double rate(const Record& record) const;
  std::vector<double> weights() const;

  std::vector<Record> records_;
};

}  // namespace fleetplan::core
