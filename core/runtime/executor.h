#pragma once

#include <cstddef>
#include <functional>

#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// Runs the independent tasks of the planner. A caller of the planner may pass an executor that uses several
/// threads. The plan does not depend on their number.
class Executor {
 public:
  using Task = std::function<void(std::size_t)>;

  Executor() = default;
  Executor(const Executor&) = delete;
  Executor& operator=(const Executor&) = delete;
  virtual ~Executor() = default;

  /// Calls task(0) ... task(count - 1), in any order and perhaps at the same time on several threads. Returns
  /// when all of them have returned. If a task throws, calls that have not begun may be skipped. The first
  /// exception is rethrown here once no call is running.
  void run(std::size_t count, const Task& task) { run_on(count, count, task); }
  /// Calls the tasks as run() does, but begins them in their order, and runs at most `threads` (at least one)
  /// at a time.
  virtual void run_on(std::size_t threads, std::size_t count, const Task& task) = 0;

  /// Whether the planner may go on improving its plan. The planner asks repeatedly, in the thread of the
  /// caller of run_on(). The answer may take until `stop` is met; meanwhile, others compute.
  virtual bool may_improve(const StopCondition& /*stop*/) { return true; }
};

/// Runs all tasks in the caller's thread.
class CallerThread : public Executor {
 public:
  void run_on(std::size_t /*threads*/, std::size_t count, const Task& task) override {
    for (std::size_t k = 0; k < count; ++k) task(k);
  }
};

}  // namespace fleetplan::core
