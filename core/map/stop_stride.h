#pragma once

#include <utility>

#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// Asks a stop condition once in so many steps of a computation. Stays met once it is.
class StopStride {
 public:
  StopStride(StopCondition stop, int stride) : stop_(std::move(stop)), stride_(stride), left_(stride) {}

  /// To be called at every step.
  bool met_at_step() {
    if (--left_ > 0) return met_;
    left_ = stride_;
    met_ = met_ || stop_.met();
    return met_;
  }
  /// Whether it was met at a step before.
  bool met() const { return met_; }

 private:
  StopCondition stop_;
  int stride_;
  int left_;  // steps until it asks
  bool met_ = false;
};

}  // namespace fleetplan::core
