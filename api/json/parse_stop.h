#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <optional>
#include <stop_token>

#include "core/runtime/stop_condition.h"

namespace fleetplan::api {

/// When reading a request ends before the request does: when its client has left or the service drains; until
/// the budget is known, after kMostCpu; from then on, when the budget is spent. Stays met once it is.
class ParseStop {
 public:
  using Clock = core::StopCondition::Clock;
  using CpuClock = std::function<std::chrono::nanoseconds()>;

  static constexpr std::chrono::seconds kMostCpu{1};
  /// A request is read for so much longer than its budget, counted from when the budget is known if that is
  /// later: so one that waited too long still gets the answer of a valid request.
  static constexpr std::chrono::milliseconds kGrace{50};
  /// Bytes or values between two looks at the clock, about a millisecond of work.
  static constexpr std::size_t kStride = 64 * 1024;

  /// Never met.
  ParseStop() = default;
  /// `received_at`: when the budget begins. `cpu_clock`: CPU time of the thread that reads.
  ParseStop(std::stop_token stop, Clock::time_point received_at, CpuClock cpu_clock = thread_cpu_time);

  /// Counts bytes or values that are read, and looks at the clock once in a while.
  bool met_after(std::size_t work) {
    work_ += work;
    return work_ < kStride ? met_ : look();
  }
  /// Looks at the clock.
  bool look();
  bool met() const { return met_; }
  bool cancelled() const { return stop_.stop_requested(); }

  void set_budget(std::chrono::nanoseconds budget);
  bool has_budget() const { return deadline_ != Clock::time_point::max(); }
  /// For computations on what was read. They end with an exception if the memory does not suffice.
  core::StopCondition condition() const { return core::StopCondition(deadline_, stop_).despite_memory(); }

  static std::chrono::nanoseconds thread_cpu_time();

 private:
  std::stop_token stop_;
  Clock::time_point received_at_ = Clock::time_point::max();
  CpuClock cpu_clock_;  // empty: no limit of CPU time
  std::chrono::nanoseconds cpu_end_{};
  Clock::time_point deadline_ = Clock::time_point::max();
  std::size_t work_ = 0;  // since the last look
  bool met_ = false;
};

}  // namespace fleetplan::api
