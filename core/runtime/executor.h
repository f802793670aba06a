#pragma once

#include <cstddef>
#include <functional>

namespace fleetplan::core {

/// Where the planner's independent pieces of work run. Whoever calls the planner may lend it other threads;
/// the plan is the same with any number of them.
class Executor {
 public:
  using Task = std::function<void(std::size_t)>;

  Executor() = default;
  Executor(const Executor&) = delete;
  Executor& operator=(const Executor&) = delete;
  virtual ~Executor() = default;

  /// Calls task(0) ... task(count - 1), in any order and perhaps at the same time on several threads, and
  /// returns when all of them have returned. If one throws, no more need be called, and the exception is
  /// thrown again here when none runs any more; the first one, if there are several.
  virtual void run(std::size_t count, const Task& task) = 0;
};

/// Runs everything in the caller's thread.
class CallerThread : public Executor {
 public:
  void run(std::size_t count, const Task& task) override {
    for (std::size_t k = 0; k < count; ++k) task(k);
  }
};

}  // namespace fleetplan::core
