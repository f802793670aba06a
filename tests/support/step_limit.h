#pragma once

#include <cstdint>
#include <limits>

#include "core/runtime/stop_condition.h"

namespace fleetplan::support {

/// Stop conditions with this limit, all asked by one thread, are met after so many questions. Conditions that
/// outlast the budget, which decide about the answer, are met after `patience` more.
class StepLimit : public core::EarlyEnd {
 public:
  static constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::max();

  explicit StepLimit(std::int64_t steps = kNever, std::int64_t patience = 0)
      : limit_(steps), patience_(patience) {}

  bool met(bool outlasts) override { return ++steps_ > end_of(outlasts); }
  bool is_over(bool outlasts) const override { return steps_ >= end_of(outlasts); }

  /// The questions so far, and the questions after the limit.
  std::int64_t steps() const { return steps_; }
  std::int64_t late() const { return steps_ - limit_; }

 private:
  std::int64_t end_of(bool outlasts) const {
    return outlasts && limit_ < kNever ? limit_ + patience_ : limit_;
  }

  std::int64_t limit_;
  std::int64_t patience_;
  std::int64_t steps_ = 0;
};

/// Returns a stop condition that only the limit meets.
inline core::StopCondition counted(StepLimit& limit) {
  return core::StopCondition(core::StopCondition::Clock::time_point::max()).ended_by(&limit);
}

}  // namespace fleetplan::support
