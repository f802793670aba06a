#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <mutex>
#include <utility>

#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// Shares the turn of a job with other jobs by time. The loops of the job ask its stop condition, which asks
/// `go_on` about every kPeriod. `go_on` may take its time while other jobs compute; meanwhile, all threads of
/// the job wait. If it returns false, the stop condition is met from then on. Conditions that outlast it, for
/// the little that is done at the end, neither ask nor end.
class SharedTurn final : public EarlyEnd {
 public:
  using GoOn = std::function<bool()>;

  static constexpr std::chrono::milliseconds kPeriod{20};

  /// `go_on` is called by any thread of the job, one at a time. Empty: the turn is not shared.
  SharedTurn(StopCondition stop, GoOn go_on) : inner_(std::move(stop)), go_on_(std::move(go_on)) {}

  /// Returns the job's condition, which shares the turn. This object must outlive it.
  StopCondition stop() { return inner_.ended_by(this); }

  /// Asks `go_on`. Returns whether the job may go on.
  bool share() {
    const std::lock_guard lock(mutex_);
    return !ended_ && ask();
  }

  /// Whether the turn has ended. Conditions check their deadlines themselves.
  bool met(bool outlasts) override {
    if (!outlasts && !ended_ && now() >= next_) share_if_due();
    return (!outlasts && ended_) || inner_.ended_early(outlasts);
  }
  bool is_over(bool outlasts) const override {
    return (!outlasts && ended_) || inner_.is_over_early(outlasts);
  }

 private:
  using Clock = StopCondition::Clock;

  static Clock::rep now() { return Clock::now().time_since_epoch().count(); }

  void share_if_due() {
    const std::lock_guard lock(mutex_);
    if (!ended_ && now() >= next_) ask();  // unless another thread has asked meanwhile
  }

  bool ask() {
    if (go_on_ && !go_on_()) ended_ = true;
    next_ = now() + Clock::duration(kPeriod).count();
    return !ended_;
  }

  const StopCondition inner_;
  const GoOn go_on_;
  std::mutex mutex_;  // held while `go_on` is asked
  std::atomic<Clock::rep> next_{Clock::time_point::min().time_since_epoch().count()};
  std::atomic<bool> ended_{false};
};

}  // namespace fleetplan::core
