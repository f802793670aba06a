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

/// Lets so many jobs compute at a time as there are workers. More wait for their turn in a bounded queue, so
/// that load beyond it is refused at once rather than kept waiting.
///
/// A job computes in the thread that asks for its turn: to hand it over to another costs more than a small
/// plan. Threads of the pool's own help with the tasks of jobs while fewer compute than there are workers.
/// Thread-safe.
class Workers : public core::Executor {
 public:
  using Clock = std::chrono::steady_clock;

  static constexpr std::chrono::milliseconds kShortWait{250};

  class Job;

  /// `workers` >= 1 jobs compute; at most `queue` are admitted beside them. Up to `burst` more are as long as
  /// the last one's turn is expected within kShortWait, so that many small requests at once are not refused
  /// for their number alone.
  Workers(int workers, std::size_t queue, std::size_t burst = 0);

  /// No job may be left.
  ~Workers() override;

  /// Takes a job in; none when the queue is full.
  std::optional<Job> admit();

  /// Seconds, at least 1, after which a refused job may find room: the work ahead by the mean job so far.
  int retry_after_s() const;

  /// Jobs that wait for their turn, and those that compute.
  std::size_t queued() const;
  std::size_t running() const;

  /// For jobs whose turn it is: the caller does the tasks, and idle workers help. Waits for no task that has
  /// not begun, so it needs no worker to be idle. A job's turn never waits for a helper.
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
  std::size_t admitted_ = 0;  // jobs there are, whether their turn has come or not
  std::size_t running_ = 0;
  std::size_t helping_ = 0;
  std::vector<std::optional<Clock::time_point>> busy_since_;  // by worker
  double mean_job_s_ = 0.0;
  bool stopping_ = false;
  std::vector<std::thread> helpers_;
};

/// A job's place among the others, given back at its end.
class Workers::Job {
 public:
  explicit Job(Workers& workers) : workers_(&workers) {}
  ~Job();
  Job(Job&& other) noexcept : workers_(other.workers_), worker_(other.worker_) { other.workers_ = nullptr; }
  Job& operator=(Job&&) = delete;

  /// Waits until the job may compute: then true, and it may until it ends. False when `stop` was met before.
  /// To be called once. Turns come in the order of these calls.
  bool await_turn(const core::StopCondition& stop);

 private:
  Workers* workers_;
  std::optional<std::size_t> worker_;  // whose turn it uses
};

}  // namespace fleetplan::server
