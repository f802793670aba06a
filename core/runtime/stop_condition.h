#pragma once

#include <chrono>
#include <stop_token>
#include <utility>

#include "core/runtime/memory_account.h"

namespace fleetplan::core {

/// When to stop: at a deadline, when a stop is requested, or while the job of the calling thread is short of
/// memory (see MemoryAccount). Cheap enough to test in every search loop.
class StopCondition {
 public:
  using Clock = std::chrono::steady_clock;

  StopCondition() = default;
  explicit StopCondition(Clock::time_point deadline, std::stop_token stop = {})
      : deadline_(deadline), stop_(std::move(stop)) {}

  bool met() const { return cancelled() || is_short_of_memory() || Clock::now() >= deadline_; }
  bool cancelled() const { return stop_.stop_requested(); }
  Clock::time_point deadline() const { return deadline_; }
  const std::stop_token& stop_token() const { return stop_; }

 private:
  Clock::time_point deadline_ = Clock::time_point::max();
  std::stop_token stop_;
};

}  // namespace fleetplan::core
