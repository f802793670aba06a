#include "server/jobs/workers.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <system_error>
#include <utility>

namespace fleetplan::server {

/// The tasks of one run(); guarded by the mutex.
struct Helpers::Tasks {
  const Task& task;
  const std::size_t threads;
  const std::size_t count;
  std::size_t begun = 0;
  std::size_t at_hand = 0;
  std::size_t helpers = 0;  // beside the caller
  std::exception_ptr failure = nullptr;
  std::condition_variable none_at_hand = {};

  bool to_do() const { return begun < count && !failure; }
  bool needs_help() const { return to_do() && helpers + 1 < threads; }
};

Helpers::Helpers(std::size_t workers) : workers_(workers) {
  // A job's own thread runs tasks as well, so one helper fewer is needed.
  try {
    for (std::size_t i = 1; i < workers_; ++i) threads_.emplace_back([this] { help(); });
  } catch (const std::system_error&) {  // no more threads are granted; the existing ones suffice
  }
}

Helpers::~Helpers() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  may_help_.notify_all();
  for (auto& thread : threads_) thread.join();
}

void Helpers::set_computing(std::size_t jobs) {
  const std::lock_guard lock(mutex_);
  computing_ = jobs;
  if (may_help()) may_help_.notify_one();
}

void Helpers::run(std::size_t threads, std::size_t count, const Task& task) {
  Tasks tasks{task, threads, count};
  std::unique_lock lock(mutex_);
  const auto place = shared_.insert(shared_.end(), &tasks);
  for (std::size_t k = 1; k < std::min({threads, count, workers_}); ++k) may_help_.notify_one();
  while (tasks.to_do()) do_next(tasks, lock);
  shared_.erase(place);
  tasks.none_at_hand.wait(lock, [&] { return tasks.at_hand == 0; });
  if (tasks.failure) std::rethrow_exception(tasks.failure);
}

Helpers::Tasks* Helpers::tasks_to_help() const {
  const auto found =
      std::find_if(shared_.begin(), shared_.end(), [](const Tasks* t) { return t->needs_help(); });
  return found == shared_.end() ? nullptr : *found;
}

void Helpers::do_next(Tasks& tasks, std::unique_lock<std::mutex>& lock) {
  const std::size_t k = tasks.begun++;
  ++tasks.at_hand;
  lock.unlock();
  std::exception_ptr failure;
  try {
    tasks.task(k);
  } catch (...) {
    failure = std::current_exception();
  }
  lock.lock();
  if (!tasks.failure) tasks.failure = std::move(failure);
  if (--tasks.at_hand == 0) tasks.none_at_hand.notify_one();
}

bool Helpers::may_help() const { return computing_ + helping_ < workers_ && tasks_to_help() != nullptr; }

void Helpers::help() {
  std::unique_lock lock(mutex_);
  while (true) {
    may_help_.wait(lock, [&] { return stopping_ || may_help(); });
    if (stopping_) return;
    Tasks& tasks = *tasks_to_help();
    ++helping_;
    ++tasks.helpers;
    do_next(tasks, lock);
    --tasks.helpers;
    --helping_;
  }
}

namespace {

constexpr double kMaxRetryAfterS = 3600.0;
constexpr double kJitter = 0.5;

}  // namespace

WorkerLoad Workers::load() const {
  const std::lock_guard lock(mutex_);
  WorkerLoad load = load_;
  load.waiting = schedule_.waiting();
  load.running = schedule_.running();
  load.paused = schedule_.paused();
  return load;
}

int Workers::retry_after_s() {
  const std::lock_guard lock(mutex_);
  const double jitter = std::uniform_real_distribution(0.0, kJitter)(random_);
  const double wait_s = schedule_.expected_wait_s(Clock::now());
  return static_cast<int>(std::clamp(std::ceil(wait_s) * (1.0 + jitter) + jitter, 1.0, kMaxRetryAfterS));
}

/// Tells that the turns have changed: `job`, which may be null, has got one. The mutex is locked.
void Workers::has_turn(Schedule::Job* job) {
  if (job != nullptr) static_cast<Job::Entry*>(job)->changed.notify_one();
  helpers_.set_computing(schedule_.running());
}

Workers::Job::Job(Workers& workers, std::string client) : workers_(workers), entry_(std::move(client)) {
  const std::lock_guard lock(workers_.mutex_);
  const auto refusal = workers_.schedule_.accept(entry_, Clock::now());
  accepted_ = !refusal;
  if (refusal) refuse(*refusal);
}

Workers::Job::~Job() {
  if (!accepted_) return;
  const std::lock_guard lock(workers_.mutex_);
  workers_.has_turn(workers_.schedule_.leave(entry_, Clock::now()));
}

/// Counts the refusal of the job. The mutex is locked.
void Workers::Job::refuse(Refusal refusal) {
  refusal_ = refusal;
  ++workers_.load_.refused[static_cast<std::size_t>(refusal)];
}

bool Workers::Job::request_turn(const Schedule::Need& need) {
  const std::lock_guard lock(workers_.mutex_);
  const auto refusal = workers_.schedule_.request_turn(entry_, need, Clock::now());
  if (refusal) refuse(*refusal);
  if (entry_.has_turn()) workers_.has_turn(nullptr);
  return !refusal;
}

bool Workers::Job::await_turn(const core::StopCondition& stop) {
  std::unique_lock lock(workers_.mutex_);
  if (wait(lock, stop, std::min(stop.deadline(), entry_.latest_start))) return true;
  if (!stop.cancelled()) refuse(Refusal::too_late);
  return false;
}

bool Workers::Job::may_improve(const core::StopCondition& stop) {
  using Next = Schedule::Improvement::Next;
  std::unique_lock lock(workers_.mutex_);
  const Schedule::Improvement improvement = workers_.schedule_.improve(entry_, Clock::now());
  if (improvement.next == Next::goes_on) return true;
  if (improvement.next == Next::ends) {
    ++workers_.load_.ended_early;
    return false;
  }
  workers_.has_turn(improvement.has_turn);
  return wait(lock, stop, stop.deadline());
}

bool Workers::Job::let_others(const core::StopCondition& stop) {
  std::unique_lock lock(workers_.mutex_);
  Schedule::Job* successor = workers_.schedule_.share(entry_, Clock::now());
  if (successor == nullptr) return true;
  workers_.has_turn(successor);
  return wait(lock, stop, stop.deadline());
}

/// Waits until the job has its turn. Returns false when `stop` is cancelled or the time is over before.
bool Workers::Job::wait(std::unique_lock<std::mutex>& lock, const core::StopCondition& stop,
                        Clock::time_point until) {
  const auto come = [&] { return entry_.has_turn(); };
  // Some libraries overflow when they wait until the end of time.
  if (until == Clock::time_point::max()) {
    entry_.changed.wait(lock, stop.stop_token(), come);
  } else {
    entry_.changed.wait_until(lock, stop.stop_token(), until, come);
  }
  if (come()) return true;
  workers_.schedule_.stop_waiting(entry_);
  return false;
}

}  // namespace fleetplan::server
