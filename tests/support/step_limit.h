#pragma once

#include <cstdint>

#include "core/runtime/stop_condition.h"

namespace fleetplan::support {

/// While it lives, this thread's stop conditions, those by default apart, are met after so many questions;
/// those that outlast the budget, which decide about the answer, after `patience` more.
class StepLimit {
 public:
  explicit StepLimit(std::int64_t steps = core::StepClock::kNever, std::int64_t patience = 0)
      : limit_(steps) {
    core::step_clock = {};
    core::step_clock.end = steps;
    core::step_clock.patience = patience;
  }
  ~StepLimit() { core::step_clock = {}; }
  StepLimit(const StepLimit&) = delete;
  StepLimit& operator=(const StepLimit&) = delete;

  /// The questions so far, and the questions after the limit.
  std::int64_t steps() const { return core::step_clock.steps; }
  std::int64_t late() const { return steps() - limit_; }

 private:
  std::int64_t limit_;
};

/// Returns a stop condition that only a StepLimit meets.
inline core::StopCondition counted() {
  return core::StopCondition(core::StopCondition::Clock::time_point::max());
}

}  // namespace fleetplan::support
