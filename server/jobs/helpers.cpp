#include "server/jobs/helpers.h"

#include <algorithm>
#include <exception>
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
  for (std::size_t i = 1; i < workers_; ++i) threads_.emplace_back([this] { help(); });
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

}  // namespace fleetplan::server
