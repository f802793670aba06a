#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <stop_token>

#include "core/runtime/memory_account.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// What one request may cost: time, CPU seconds and memory, and whether anybody still waits for the answer.
/// There is one object for a request. Reading the body asks it directly; computations ask a StopCondition,
/// which only a Work makes, or another StopCondition. So nothing that takes one as a parameter can be called
/// without the bounds of a request.
///
/// Reading ends when the client has left or the service drains; after kMostCpu until the budget is known, and
/// after kMostCpuOfReading in all; and when the budget is spent.
class Work {
 public:
  using Clock = StopCondition::Clock;
  using CpuClock = std::function<std::chrono::nanoseconds()>;

  static constexpr std::chrono::seconds kMostCpu{1};
  /// The most CPU time of reading, whatever the budget, as other requests wait to be read.
  static constexpr std::chrono::seconds kMostCpuOfReading{3};
  /// How much longer than its budget a request is read, counted from when the budget is known if that is
  /// later: so a request that waited too long still gets the answer of a valid one.
  static constexpr std::chrono::milliseconds kGrace{50};
  /// Bytes or values between two looks at the clock, about a millisecond of work.
  static constexpr std::size_t kStride = 64 * 1024;

  struct Bounds {
    std::stop_token stop = {};                     // when the client has left, or the service drains
    Clock::time_point received_at = Clock::now();  // the begin of the budget
    std::size_t memory = kUnlimitedMemory;         // bytes
    CpuClock cpu_clock = thread_cpu_time;          // CPU time of the thread that reads
  };
  static constexpr std::size_t kUnlimitedMemory = std::size_t{1} << 62;

  explicit Work(Bounds bounds);
  /// Work without any bounds: for what the service itself has written, and for tests.
  static Work unbounded() { return Work(); }
  Work(const Work&) = delete;
  Work& operator=(const Work&) = delete;

  /// Counts bytes or values that are read, and looks at the clock once in a while. Returns true when reading
  /// has to end, and from then on.
  bool met_after(std::size_t amount) {
    amount_ += amount;
    return amount_ < kStride ? met_ : look();
  }
  /// Looks at the clock. Returns true when reading has to end.
  bool look();
  bool met() const { return met_; }
  bool cancelled() const { return bounds_.stop.stop_requested(); }

  /// Sets the budget of the request, once it is read.
  void set_budget(std::chrono::nanoseconds budget);
  bool has_budget() const { return budget_.has_value(); }

  /// Ends reading: from now on, only the budget bounds the work, if there is one.
  void end_reading();

  /// The condition for computations while the request is read. They end with an exception if the memory does
  /// not suffice.
  StopCondition reading() const { return until(deadline_).despite_memory(); }
  /// The condition that is met at the end of the budget, less `kept` for later work; never without a budget.
  StopCondition before_end(std::chrono::nanoseconds kept = {}) const;
  /// The condition that is met at `time`, or when nobody waits for the answer.
  StopCondition until(Clock::time_point time) const { return StopCondition(time, bounds_.stop); }

  /// The account of the memory that the request's threads have allocated; see MemoryScope.
  const std::shared_ptr<MemoryAccount>& memory() const { return memory_; }

 private:
  Work() = default;

  Bounds bounds_ = {};
  std::shared_ptr<MemoryAccount> memory_ = std::make_shared<MemoryAccount>(kUnlimitedMemory);
  bool is_bounded_ = false;
  std::chrono::nanoseconds cpu_begin_{0};
  std::optional<std::chrono::nanoseconds> cpu_end_;
  std::optional<std::chrono::nanoseconds> budget_;
  Clock::time_point deadline_ = Clock::time_point::max();  // the end of reading
  std::size_t amount_ = 0;                                 // bytes or values since the last look
  bool met_ = false;
};

}  // namespace fleetplan::core
