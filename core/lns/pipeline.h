#pragma once

// Lets iterations of large neighbourhood search overlap: they run at the same time and end in order.

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <mutex>
#include <optional>
#include <utility>

namespace fleetplan::core {

/// Steps that run at the same time on several threads, but whose results depend only on their order. Step k
/// begins with the results of the steps up to k - lag, on any number of threads. So a thread waits only if
/// step k - lag still runs.
template <class Step>
class Pipeline {
 public:
  /// A step that runs, or none. The step ends when this object is destroyed.
  class Running;

  explicit Pipeline(std::size_t lag) : lag_(lag) {}

  /// Begins the next step, on the thread that will run it. Waits until the step `lag` before it has ended,
  /// and completes that step. `complete(step)` and `next()` are called in the order of the steps, one at a
  /// time. `next()` returns the step, or nothing if there is none.
  ///
  /// Exceptions are passed on. A step whose completion throws remains. A step whose `next()` throws does not
  /// begin.
  template <class Complete, class Next>
  Running begin(const Complete& complete, const Next& next) {
    std::unique_lock lock(mutex_);
    ended_.wait(lock, [&] { return entries_.size() < lag_ || entries_.front().has_ended; });
    if (entries_.size() == lag_) complete_first(complete);
    std::optional<Step> step = next();
    if (!step) return {};
    entries_.push_back({std::move(*step)});
    return {*this, entries_.back()};
  }

  /// Completes the steps that are left. All of them must have ended.
  template <class Complete>
  void complete_all(const Complete& complete) {
    while (!entries_.empty()) complete_first(complete);
  }

 private:
  struct Entry {
    Step step;
    bool has_ended = false;
  };

  template <class Complete>
  void complete_first(const Complete& complete) {
    complete(entries_.front().step);
    entries_.pop_front();
  }

  void end(Entry& entry) {
    {
      const std::scoped_lock lock(mutex_);
      entry.has_ended = true;
    }
    ended_.notify_all();
  }

  const std::size_t lag_;
  std::mutex mutex_;
  std::condition_variable ended_;
  std::deque<Entry> entries_;  // steps that have begun and are not completed; their addresses last
};

template <class Step>
class Pipeline<Step>::Running {
 public:
  Running() = default;
  Running(Pipeline& pipeline, Entry& entry) : pipeline_(&pipeline), entry_(&entry) {}
  ~Running() {
    if (entry_ != nullptr) pipeline_->end(*entry_);
  }
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;

  explicit operator bool() const { return entry_ != nullptr; }
  Step& operator*() const { return entry_->step; }

 private:
  Pipeline* pipeline_ = nullptr;
  Entry* entry_ = nullptr;
};

}  // namespace fleetplan::core
