#pragma once

// When computations stop: conditions that loops ask, and the work of a request, which makes them.

#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <utility>

#include "core/runtime/memory_account.h"

namespace fleetplan::core {

/// Ends computations before their deadline. Tests count questions with it instead of seconds, which is the
/// same on every machine. `outlasts`: whether the condition that is asked outlasts the budget, to decide
/// about the answer.
class EarlyEnd {
 public:
  EarlyEnd() = default;
  EarlyEnd(const EarlyEnd&) = delete;
  EarlyEnd& operator=(const EarlyEnd&) = delete;
  virtual ~EarlyEnd() = default;

  /// Returns whether it is met. Called whenever a condition is asked, by any thread of the job.
  virtual bool met(bool outlasts) = 0;
  virtual bool is_over(bool outlasts) const = 0;
};

/// Returns the CPU time that the calling thread has had.
std::chrono::nanoseconds thread_cpu_time();

/// When to stop: at a deadline, when a stop is requested, or while the job of the calling thread is short of
/// memory (see MemoryAccount). Cheap enough to test in every search loop.
///
/// In the service, conditions come from the Work of a request, or from other conditions: by `until` and
/// `even_if_cancelled`. tests/architecture rejects any other condition in the sources, so that no loop of a
/// request is without its bounds.
class StopCondition {
 public:
  using Clock = std::chrono::steady_clock;

  explicit StopCondition(Clock::time_point deadline, std::stop_token stop = {})
      : is_bounded_(true), deadline_(deadline), stop_(std::move(stop)) {}
  /// Returns a condition that is never met, for tests and benchmarks.
  static StopCondition never() { return StopCondition(); }

  bool met() const {
    if (!is_bounded_) return false;
    return (early_ != nullptr && early_->met(outlasts_)) || cancelled() ||
           (heeds_memory_ && is_short_of_memory()) || is_late();
  }
  /// Returns this condition, but not met while the job is short of memory. For the end of a job, which has
  /// memory set apart.
  StopCondition despite_memory() const {
    StopCondition without = *this;
    without.heeds_memory_ = false;
    return without;
  }
  /// Returns this condition with a guarantee: it is not met by time before the calling thread has had so much
  /// CPU time from now on. On a busy machine, time passes while the thread cannot work. Only the calling
  /// thread may ask it.
  StopCondition with_cpu_time(std::chrono::nanoseconds least) const {
    StopCondition patient = *this;
    patient.cpu_end_ = thread_cpu_time() + least;
    return patient;
  }
  /// Returns a condition that is met at `deadline`, or when a stop is requested.
  StopCondition until(Clock::time_point deadline) const {
    StopCondition other(deadline, stop_);
    other.early_ = early_;
    other.outlasts_ = outlasts_ || deadline > deadline_;
    return other;
  }
  /// Returns a condition that is met only at `deadline`. For the little that is done after a stop was
  /// requested.
  StopCondition even_if_cancelled(Clock::time_point deadline) const {
    StopCondition other(deadline);
    other.early_ = early_;
    other.outlasts_ = true;
    return other;
  }
  /// Returns this condition, but also met when `early` says so. Null: it is met as without `early`.
  StopCondition ended_by(EarlyEnd* early) const {
    StopCondition other = *this;
    other.early_ = early;
    return other;
  }
  /// What ends this condition early, see EarlyEnd. For conditions that replace it.
  bool ended_early(bool outlasts) const { return early_ != nullptr && early_->met(outlasts); }
  bool is_over_early(bool outlasts) const { return early_ != nullptr && early_->is_over(outlasts); }
  bool cancelled() const { return stop_.stop_requested(); }
  /// Whether the time is over: cancelled, or after the deadline. Other reasons to stop do not count.
  bool is_over() const {
    return is_bounded_ && ((early_ != nullptr && early_->is_over(outlasts_)) || cancelled() || is_late());
  }
  Clock::time_point deadline() const { return deadline_; }
  const std::stop_token& stop_token() const { return stop_; }

 private:
  StopCondition() = default;

  bool is_late() const { return Clock::now() >= deadline_ && !is_patient(); }
  bool is_patient() const { return cpu_end_.count() > 0 && thread_cpu_time() < cpu_end_; }

  bool is_bounded_ = false;
  bool heeds_memory_ = true;
  bool outlasts_ = false;  // it outlasts the budget: for what is done after it
  EarlyEnd* early_ = nullptr;
  Clock::time_point deadline_ = Clock::time_point::max();
  std::chrono::nanoseconds cpu_end_{0};  // of the calling thread; 0: none
  std::stop_token stop_;
};

/// Returns a condition that is met after a share of the time that remains until `stop`, or when `stop` is
/// cancelled.
inline StopCondition after_share(const StopCondition& stop, double share) {
  using Clock = StopCondition::Clock;
  if (stop.deadline() == Clock::time_point::max()) return stop;
  const auto now = Clock::now();
  const auto remaining = std::chrono::duration_cast<Clock::duration>((stop.deadline() - now) * share);
  return stop.until(now + remaining);
}

/// Asks a stop condition, which must outlive it, once in so many steps of a computation. Computations with
/// short steps must use it; tests/architecture checks this. Stays met once it is met.
class StopStride {
 public:
  /// Asks at the step that completes `stride` steps, and then once in every `stride` steps.
  StopStride(const StopCondition& stop, std::size_t stride) : stop_(&stop), stride_(stride) {}
  StopStride(const StopCondition&& stop, std::size_t stride) = delete;
  /// Asks already at the first step, and then once in every `stride` steps.
  static StopStride from_first(const StopCondition& stop, std::size_t stride) {
    StopStride first(stop, stride);
    first.done_ = stride - 1;
    return first;
  }
  static StopStride from_first(const StopCondition&& stop, std::size_t stride) = delete;

  /// To be called at every step.
  bool met_at_step() { return met_after(1); }
  /// Must be called at each step. The step counts as so many steps.
  bool met_after(std::size_t steps) {
    done_ += steps;
    if (done_ < stride_) return met_;
    done_ = 0;
    met_ = met_ || stop_->met();
    return met_;
  }
  /// Whether it was met at a step before.
  bool met() const { return met_; }

 private:
  const StopCondition* stop_;
  std::size_t stride_;
  std::size_t done_ = 0;  // steps since it asked
  bool met_ = false;
};

/// What one request may cost: time, CPU seconds and memory, and whether anybody still waits for the answer.
/// There is one object for a request. Reading the body asks it directly. Computations ask a StopCondition,
/// which only a Work or another StopCondition can make. So functions that take either as a parameter can only
/// be called within the bounds of a request.
///
/// Reading ends when
///
/// - the client has left or the service drains,
/// - it has used kMaxCpu before the budget is known, or kMaxCpuOfReading in all,
/// - or the budget is spent.
class Work {
 public:
  using Clock = StopCondition::Clock;
  using CpuClock = std::function<std::chrono::nanoseconds()>;

  static constexpr std::chrono::seconds kMaxCpu{1};
  /// The most CPU time of reading, whatever the budget, because other requests wait to be read.
  static constexpr std::chrono::seconds kMaxCpuOfReading{3};
  /// How much longer than its budget a request is read. It counts from the time when the budget is known, if
  /// that is later. So a request that waited too long still gets the answer of a valid request.
  static constexpr std::chrono::milliseconds kGrace{50};
  /// Bytes or values between two looks at the clock, about a millisecond of work.
  static constexpr std::size_t kStride = 64 * 1024;

  struct Bounds {
    std::stop_token stop = {};                     // when the client has left, or the service drains
    Clock::time_point received_at = Clock::now();  // the begin of the budget
    std::size_t memory = kUnlimitedMemory;         // bytes
    CpuClock cpu_clock = thread_cpu_time;          // CPU time of the thread that reads
    EarlyEnd* early_end = nullptr;                 // null: none
  };
  static constexpr std::size_t kUnlimitedMemory = std::size_t{1} << 62;

  explicit Work(Bounds bounds);
  /// Work without any bounds: for texts that the service itself has written, and for tests.
  static Work unbounded() { return Work(); }
  Work(const Work&) = delete;
  Work& operator=(const Work&) = delete;

  /// Counts bytes or values that are read, and looks at the clock once in a while. Returns true as soon as
  /// reading has to end.
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
  /// The condition that is met at the end of the budget, minus `kept` for later work. Never met without a
  /// budget.
  StopCondition before_end(std::chrono::nanoseconds kept = {}) const;
  /// The condition that is met at `time`, or when nobody waits for the answer.
  StopCondition until(Clock::time_point time) const {
    return StopCondition(time, bounds_.stop).ended_by(bounds_.early_end);
  }

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
