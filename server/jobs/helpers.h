#pragma once

#include <condition_variable>
#include <cstddef>
#include <list>
#include <mutex>
#include <thread>
#include <vector>

#include "core/runtime/executor.h"

namespace fleetplan::server {

/// Threads that run tasks of jobs while fewer jobs compute than there are workers. Thread-safe.
class Helpers {
 public:
  using Task = core::Executor::Task;

  explicit Helpers(std::size_t workers);
  /// No job may be left.
  ~Helpers();
  Helpers(const Helpers&) = delete;
  Helpers& operator=(const Helpers&) = delete;

  /// How many jobs compute, whose threads are not idle.
  void set_computing(std::size_t jobs);

  /// For jobs whose turn it is: the caller runs the tasks, and idle workers help. It never waits for a task
  /// that has not begun, so no worker has to be idle. See Executor::run_on.
  void run(std::size_t threads, std::size_t count, const Task& task);

 private:
  struct Tasks;

  void help();
  bool may_help() const;
  Tasks* tasks_to_help() const;
  static void do_next(Tasks& tasks, std::unique_lock<std::mutex>& lock);

  const std::size_t workers_;
  std::mutex mutex_;
  std::condition_variable may_help_;
  std::list<Tasks*> shared_;  // of the jobs that are in run()
  std::size_t computing_ = 0;
  std::size_t helping_ = 0;
  bool stopping_ = false;
  std::vector<std::thread> threads_;
};

}  // namespace fleetplan::server
