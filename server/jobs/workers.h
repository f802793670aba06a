#pragma once

#include <condition_variable>
#include <cstddef>
#include <list>
#include <mutex>
#include <optional>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "core/runtime/executor.h"
#include "core/runtime/stop_condition.h"
#include "server/jobs/schedule.h"
#include "server/ops/metrics.h"

namespace fleetplan::server {

/// Threads that run tasks of jobs while fewer jobs compute than there are workers. Thread-safe.
class Helpers {
 public:
  using Task = core::Executor::Task;

  /// There are fewer threads than workers - 1 if the system grants no more.
  explicit Helpers(std::size_t workers);
  /// No job may be left when this is destroyed.
  ~Helpers();
  Helpers(const Helpers&) = delete;
  Helpers& operator=(const Helpers&) = delete;

  /// Sets how many jobs compute. Their threads are not idle.
  void set_computing(std::size_t jobs);

  /// Runs tasks of a job whose turn it is: the caller runs them, and idle workers help. It never waits for a
  /// task that has not begun, so it works without idle workers. See Executor::run_on.
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
  std::list<Tasks*> shared_;  // tasks of the jobs that are in run()
  std::size_t computing_ = 0;
  std::size_t helping_ = 0;
  bool stopping_ = false;
  std::vector<std::thread> threads_;
};

/// Gives jobs their turns as the schedule decides. A job computes in the thread that awaits its turn, because
/// a handover to another thread costs more than a small plan. Thread-safe.
class Workers {
 public:
  using Clock = std::chrono::steady_clock;
  class Job;

  /// Makes workers for a schedule of this size, see Schedule.
  explicit Workers(Schedule::Size size) : schedule_(size), helpers_(size.workers) {}

  WorkerLoad load() const;

  /// Returns the seconds, at least 1, after which a refused job may find room. This is the expected time
  /// until a turn is free, plus up to half of it at random. So refused clients do not return all at once.
  int retry_after_s();

 private:
  void has_turn(Schedule::Job* job);

  mutable std::mutex mutex_;
  Schedule schedule_;
  WorkerLoad load_;  // only the counted members are used
  std::minstd_rand random_;
  Helpers helpers_;
};

/// A job's place in the queue and among the workers, until its end. Its functions are called by the thread
/// that computes it.
class Workers::Job final : public core::Executor {
 public:
  /// Accepts the job, or refuses it. A refused job does nothing more. See Schedule::Job for `client`.
  Job(Workers& workers, std::string client);
  ~Job() override;

  /// The reason why the job was refused; none if it has not been refused.
  std::optional<Refusal> refusal() const { return refusal_; }

  /// Asks for the job's turn, once. Returns false if it is refused.
  bool request_turn(const Schedule::Need& need);

  /// Waits for the turn, which lasts until the job's end, except for pauses. Returns false if `stop` is met
  /// before. Then the job is refused, or cancelled.
  bool await_turn(const core::StopCondition& stop);

  /// Runs the tasks in this thread and with idle workers.
  void run_on(std::size_t threads, std::size_t count, const Task& task) override {
    workers_.helpers_.run(threads, count, task);
  }

  /// Gives the turn away while others wait for their first plans.
  bool may_improve(const core::StopCondition& stop) override;

  /// Gives the turn to other jobs if it has lasted long, and waits for the next turn. Returns false if `stop`
  /// is met before.
  bool let_others(const core::StopCondition& stop);

 private:
  friend class Workers;

  /// A job of the schedule with the means to wait. Guarded by the mutex of the workers.
  struct Entry : Schedule::Job {
    using Schedule::Job::Job;
    std::condition_variable_any changed = {};
  };

  bool wait(std::unique_lock<std::mutex>& lock, const core::StopCondition& stop, Clock::time_point until);
  void refuse(Refusal refusal);

  Workers& workers_;
  Entry entry_;
  std::optional<Refusal> refusal_;
  bool accepted_ = false;
};

}  // namespace fleetplan::server
