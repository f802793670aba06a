#include "server/worker_pool.h"

#include <algorithm>
#include <cmath>
#include <exception>
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

/// What one run() is about; guarded by the pool's mutex.
struct WorkerPool::Tasks {
  const Task& task;
  const std::size_t count;
  std::size_t begun = 0;
  std::size_t at_hand = 0;
  std::exception_ptr failure = nullptr;
  std::condition_variable none_at_hand = {};

  bool to_do() const { return begun < count && !failure; }
};

WorkerPool::WorkerPool(int workers, std::size_t queue, std::size_t burst)
    : capacity_(queue), burst_(burst), busy_since_(static_cast<std::size_t>(workers)) {
  threads_.reserve(busy_since_.size());
  for (std::size_t i = 0; i < busy_since_.size(); ++i) threads_.emplace_back([this, i] { work(i); });
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
    if (!has_room()) return std::nullopt;
    queue_.push_back(ticket);
  }
  work_available_.notify_one();
  return ticket;
}

bool WorkerPool::has_room() const {
  // Idle workers are about to empty the queue, so they count as room.
  const std::size_t beyond = queue_.size() + running_ + 1;
  const std::size_t room = capacity_ + busy_since_.size();
  if (beyond <= room) return true;
  return beyond <= room + burst_ && expected_wait_s() <= std::chrono::duration<double>(kShortWait).count();
}

/// All the work ahead, by the mean job so far or the longest running one if that is longer.
double WorkerPool::expected_wait_s() const {
  double job_s = mean_job_s_;
  const auto now = Clock::now();
  for (const auto& since : busy_since_) {
    if (since) job_s = std::max(job_s, std::chrono::duration<double>(now - *since).count());
  }
  return static_cast<double>(queue_.size() + running_) * job_s / static_cast<double>(busy_since_.size());
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
  return static_cast<int>(std::clamp(std::ceil(expected_wait_s()), 1.0, kMaxRetryAfterS));
}

std::size_t WorkerPool::queued() const {
  const std::lock_guard lock(mutex_);
  return queue_.size();
}

void WorkerPool::run(std::size_t count, const Task& task) {
  Tasks tasks{task, count};
  std::unique_lock lock(mutex_);
  const auto place = shared_.insert(shared_.end(), &tasks);
  lock.unlock();
  for (std::size_t k = 1; k < std::min(count, busy_since_.size()); ++k) work_available_.notify_one();
  lock.lock();
  while (tasks.to_do()) do_next(tasks, lock);
  shared_.erase(place);
  tasks.none_at_hand.wait(lock, [&] { return tasks.at_hand == 0; });
  if (tasks.failure) std::rethrow_exception(tasks.failure);
}

WorkerPool::Tasks* WorkerPool::tasks_to_do() const {
  const auto found = std::find_if(shared_.begin(), shared_.end(), [](const Tasks* t) { return t->to_do(); });
  return found == shared_.end() ? nullptr : *found;
}

void WorkerPool::do_next(Tasks& tasks, std::unique_lock<std::mutex>& lock) {
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

void WorkerPool::work(std::size_t worker) {
  std::unique_lock lock(mutex_);
  while (true) {
    work_available_.wait(lock, [&] { return stopping_ || !queue_.empty() || tasks_to_do() != nullptr; });
    if (!queue_.empty()) {
      do_next_job(worker, lock);
    } else if (stopping_) {
      return;
    } else {
      do_next(*tasks_to_do(), lock);
    }
  }
}

void WorkerPool::do_next_job(std::size_t worker, std::unique_lock<std::mutex>& lock) {
  const Ticket ticket = std::move(queue_.front());
  queue_.pop_front();
  ++running_;
  const auto begin = Clock::now();
  busy_since_[worker] = begin;
  lock.unlock();

  ticket->job();
  ticket->job = nullptr;
  const double seconds = std::chrono::duration<double>(Clock::now() - begin).count();

  lock.lock();
  --running_;
  busy_since_[worker].reset();
  mean_job_s_ = mean_job_s_ == 0.0 ? seconds : mean_job_s_ + kNewestWeight * (seconds - mean_job_s_);
  ticket->done = true;
  ticket->finished.notify_all();
}

}  // namespace fleetplan::server
