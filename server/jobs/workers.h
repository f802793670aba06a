#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <list>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "core/runtime/executor.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::server {

/// Lets as many jobs compute at a time as there are workers. More wait for their turn in a bounded queue;
/// load beyond it is rejected immediately.
///
/// A job computes in the thread that awaits its turn: a handover to another thread costs more than a small
/// plan. Helper threads run tasks of jobs while fewer jobs compute than there are workers.
/// Thread-safe.
class Workers : public core::Executor {
 public:
  using Clock = std::chrono::steady_clock;

  static constexpr std::chrono::milliseconds kShortWait{250};

  class Job;

  /// `workers` >= 1 jobs compute; at most `queue` more are accepted. Up to `burst` more are accepted as long
  /// as the turn of the last one is expected within kShortWait, so that many small requests at once are not
  /// rejected for their number alone.
  Workers(int workers, std::size_t queue, std::size_t burst = 0);

  /// No job may be left.
  ~Workers() override;

  /// Accepts a job; none when the queue is full.
  std::optional<Job> admit();

  /// Seconds, at least 1, after which a refused job may find room: the work ahead by the mean job so far.
  int retry_after_s() const;

  /// Jobs that wait for their turn, and those that compute.
  std::size_t queued() const;
  std::size_t running() const;

  /// For jobs whose turn it is: the caller runs the tasks, and idle workers help. It never waits for a task
  /// that has not begun, so no worker has to be idle. A job's turn never waits for a helper.
  void run(std::size_t count, const Task& task) override;

 private:
  struct Tasks;
  struct Waiting;

  void help();
  bool may_help() const;
  Tasks* tasks_to_do() const;
  static void do_next(Tasks& tasks, std::unique_lock<std::mutex>& lock);
  bool has_room() const;
  double expected_wait_s() const;
  std::size_t begin_turn();
  void end_turn(std::size_t worker);

  const std::size_t capacity_;
  const std::size_t burst_;
  mutable std::mutex mutex_;
  std::condition_variable may_help_;
  std::list<Waiting*> queue_;
  std::list<Tasks*> shared_;  // of the jobs that are in run()
  std::size_t admitted_ = 0;  // jobs, whether their turn has come or not
  std::size_t running_ = 0;
  std::size_t helping_ = 0;
  std::vector<std::optional<Clock::time_point>> busy_since_;  // by worker
  double mean_job_s_ = 0.0;
  bool stopping_ = false;
  std::vector<std::thread> helpers_;
};

/// A job's place among the others, until its end.
class Workers::Job {
 public:
  explicit Job(Workers& workers) : workers_(&workers) {}
  ~Job();
  Job(Job&& other) noexcept : workers_(other.workers_), worker_(other.worker_) { other.workers_ = nullptr; }
  Job& operator=(Job&&) = delete;

  /// Waits for the job's turn, which lasts until the job's end. Returns false if `stop` is met before.
  /// Call it once. Turns are given in the order of these calls.
  bool await_turn(const core::StopCondition& stop);

 private:
  Workers* workers_;
  std::optional<std::size_t> worker_;  // whose turn it uses
};

}  // namespace fleetplan::server
