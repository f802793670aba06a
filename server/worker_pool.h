#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "core/parallel/executor.h"

namespace fleetplan::server {

/// Threads that plan, with a bounded queue in front of them, so that load beyond it is refused at once rather
/// than kept waiting. Jobs are taken in order; workers that find none help with the tasks of those that run.
/// Thread-safe.
class WorkerPool : public core::Executor {
 public:
  using Job = std::function<void()>;  // must not throw
  using Clock = std::chrono::steady_clock;

  static constexpr std::chrono::milliseconds kShortWait{250};

  struct Entry;
  using Ticket = std::shared_ptr<Entry>;

  /// `workers` >= 1 threads; at most `queue` jobs wait beside the running ones (0: only idle workers take
  /// any). Up to `burst` more may wait as long as the last one's turn is expected within kShortWait, so that
  /// many small requests at once are not refused for their number alone.
  WorkerPool(int workers, std::size_t queue, std::size_t burst = 0);

  /// Finishes all jobs taken.
  ~WorkerPool() override;

  /// Takes a job; none when the queue is full.
  std::optional<Ticket> submit(Job job);

  /// True when the job has finished, waiting for at most `patience`.
  bool wait_for(const Ticket& ticket, std::chrono::milliseconds patience);

  /// Takes a job back; false when it has been started already.
  bool withdraw(const Ticket& ticket);

  /// Seconds, at least 1, after which a refused job may find room: the work ahead by the mean job so far.
  int retry_after_s() const;

  /// Jobs that wait.
  std::size_t queued() const;

  /// For jobs: the caller does the tasks, and workers as long as they have no job. Waits for no task that has
  /// not begun, so it needs no worker to be idle. A job never waits for more than the task at hand, and a
  /// worker that helps still counts as idle.
  void run(std::size_t count, const Task& task) override;

 private:
  struct Tasks;

  void work(std::size_t worker);
  void do_next_job(std::size_t worker, std::unique_lock<std::mutex>& lock);
  Tasks* tasks_to_do() const;
  static void do_next(Tasks& tasks, std::unique_lock<std::mutex>& lock);
  bool has_room() const;
  double expected_wait_s() const;

  const std::size_t capacity_;
  const std::size_t burst_;
  mutable std::mutex mutex_;
  std::condition_variable work_available_;
  std::list<Ticket> queue_;
  std::list<Tasks*> shared_;  // of the jobs that are in run()
  std::size_t running_ = 0;
  std::vector<std::optional<Clock::time_point>> busy_since_;  // by worker
  double mean_job_s_ = 0.0;
  bool stopping_ = false;
  std::vector<std::thread> threads_;
};

}  // namespace fleetplan::server
