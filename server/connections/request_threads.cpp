
#include "server/connections/request_threads.h"

#include <system_error>
#include <utility>

namespace fleetplan::server {

namespace {

constexpr std::chrono::seconds kKeepIdleThread{10};

}  // namespace

RequestThreads::~RequestThreads() { shutdown(); }

void RequestThreads::push(std::function<void()> task) {
  reap();
  const std::lock_guard lock(mutex_);
  tasks_.push_back(std::move(task));
  if (tasks_.size() > idle_ && threads_.size() < max_threads_) {
    // The thread cannot read its own entry before this lock is released.
    const auto self = threads_.emplace(threads_.end());
    try {
      *self = std::thread([this, self] { work(self); });
    } catch (const std::system_error&) {
      threads_.erase(self);  // no more threads are available: the request waits for an existing one
      if (threads_.empty()) throw;
    }
  }
  changed_.notify_one();
}

void RequestThreads::shutdown() {
  std::unique_lock lock(mutex_);
  stopping_ = true;
  changed_.notify_all();
  changed_.wait(lock, [&] { return threads_.empty(); });
  lock.unlock();
  reap();
}

void RequestThreads::reap() {
  Threads ended;
  {
    const std::lock_guard lock(mutex_);
    ended.swap(ended_);
  }
  for (auto& thread : ended) thread.join();
}

void RequestThreads::work(Threads::iterator self) {
  std::unique_lock lock(mutex_);
  while (true) {
    ++idle_;
    const bool woken = changed_.wait_for(lock, kKeepIdleThread, [&] { return stopping_ || !tasks_.empty(); });
    --idle_;
    if (tasks_.empty() && (stopping_ || !woken)) break;
    const auto task = std::move(tasks_.front());
    tasks_.pop_front();
    lock.unlock();
    task();
    lock.lock();
  }
  ended_.splice(ended_.end(), threads_, self);
  changed_.notify_all();
}

}  // namespace fleetplan::server
