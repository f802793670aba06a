#include "server/worker_pool.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace fleetplan::server {

namespace {

/// Weight of the newest job in the running mean: about the last ten count.
constexpr double kNewestWeight = 0.1;
constexpr double kMaxRetryAfterS = 3600.0;

}  // namespace

struct WorkerPool::Entry {
  Job job;
  bool done = false;  // guarded by the pool's mutex
  std::condition_variable finished;
};

WorkerPool::WorkerPool(int workers, std::size_t queue) : capacity_(queue) {
  threads_.reserve(static_cast<std::size_t>(workers));
  for (int i = 0; i < workers; ++i) threads_.emplace_back([this] { work(); });
}

WorkerPool::~WorkerPool() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  work_available_.notify_all();
  for (auto& thread : threads_) thread.join();
}

std::optional<WorkerPool::Ticket> WorkerPool::submit(Job job) {
  auto ticket = std::make_shared<Entry>();
  ticket->job = std::move(job);
  {
    const std::lock_guard lock(mutex_);
    // Idle workers are about to empty the queue, so they count as room.
    if (queue_.size() + running_ >= capacity_ + threads_.size()) return std::nullopt;
    queue_.push_back(ticket);
  }
  work_available_.notify_one();
  return ticket;
}

bool WorkerPool::wait_for(const Ticket& ticket, std::chrono::milliseconds patience) {
  std::unique_lock lock(mutex_);
  return ticket->finished.wait_for(lock, patience, [&] { return ticket->done; });
}

bool WorkerPool::withdraw(const Ticket& ticket) {
  const std::lock_guard lock(mutex_);
  return std::erase(queue_, ticket) > 0;
}

int WorkerPool::retry_after_s() const {
  const std::lock_guard lock(mutex_);
  const double ahead = static_cast<double>(queue_.size() + running_);
  const double seconds = std::ceil(ahead * mean_job_s_ / static_cast<double>(threads_.size()));
  return static_cast<int>(std::clamp(seconds, 1.0, kMaxRetryAfterS));
}

std::size_t WorkerPool::queued() const {
  const std::lock_guard lock(mutex_);
  return queue_.size();
}

void WorkerPool::work() {
  std::unique_lock lock(mutex_);
  while (true) {
    work_available_.wait(lock, [&] { return stopping_ || !queue_.empty(); });
    if (queue_.empty()) return;
    const Ticket ticket = std::move(queue_.front());
    queue_.pop_front();
    ++running_;
    lock.unlock();

    const auto begin = Clock::now();
    ticket->job();
    ticket->job = nullptr;
    const double seconds = std::chrono::duration<double>(Clock::now() - begin).count();

    lock.lock();
    --running_;
    mean_job_s_ = mean_job_s_ == 0.0 ? seconds : mean_job_s_ + kNewestWeight * (seconds - mean_job_s_);
    ticket->done = true;
    ticket->finished.notify_all();
  }
}

}  // namespace fleetplan::server
