#pragma once

#include <algorithm>
#include <cstddef>

#include "core/execution/simulation/executed_motion.h"

namespace fleetplan::core {

/// Adds to the progress of a robot, from t = 0 on.
class ProgressBuilder {
 public:
  double now() const { return now_; }
  double fraction() const { return fraction_; }

  void begin_action(std::size_t action) {
    action_ = action;
    fraction_ = 0.0;
    add_knot();
  }
  void stand_for(double seconds) { go_on(seconds, fraction_); }
  void stand_until(double t) { go_on(std::max(0.0, t - now_), fraction_); }
  /// At constant speed to a fraction of the action.
  void go_on(double seconds, double to_fraction) {
    if (seconds <= 0.0 && to_fraction == fraction_) return;
    now_ += seconds;
    fraction_ = to_fraction;
    add_knot();
  }

  const ExecutedProgress& progress() const { return progress_; }
  ExecutedProgress& progress() { return progress_; }

 private:
  void add_knot() { progress_.knots.push_back({now_, action_, fraction_}); }

  double now_ = 0.0;
  std::size_t action_ = 0;
  double fraction_ = 0.0;
  ExecutedProgress progress_;
};

}  // namespace fleetplan::core
