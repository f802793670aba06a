#include "server/jobs/workers.h"

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

/// A job that waits; guarded by the mutex.
struct Workers::Waiting {
  std::optional<std::size_t> worker = std::nullopt;  // its turn has come
  std::condition_variable_any changed = {};
};

/// The tasks of one run(); guarded by the mutex.
struct Workers::Tasks {
  const Task& task;
  const std::size_t count;
  std::size_t begun = 0;
  std::size_t at_hand = 0;
  std::exception_ptr failure = nullptr;
  std::condition_variable none_at_hand = {};

  bool to_do() const { return begun < count && !failure; }
};

Workers::Workers(int workers, std::size_t queue, std::size_t burst)
    : capacity_(queue), burst_(burst), busy_since_(static_cast<std::size_t>(workers)) {
  // A job's own thread runs tasks as well, so one helper fewer is needed.
  for (std::size_t i = 1; i < busy_since_.size(); ++i) helpers_.emplace_back([this] { help(); });
}

Workers::~Workers() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  may_help_.notify_all();
  for (auto& helper : helpers_) helper.join();
}

std::optional<Workers::Job> Workers::admit() {
  const std::lock_guard lock(mutex_);
  if (!has_room()) return std::nullopt;
  ++admitted_;
  return Job(*this);
}

bool Workers::has_room() const {
  const std::size_t room = capacity_ + busy_since_.size();
  if (admitted_ < room) return true;
  return admitted_ < room + burst_ && expected_wait_s() <= std::chrono::duration<double>(kShortWait).count();
}

/// All the work ahead: a job that runs takes at least as long again as it has run already, the others as long
/// as the mean job so far, or the longest running one while none has ended.
double Workers::expected_wait_s() const {
  const auto now = Clock::now();
  double running_s = 0.0;
  double longest_s = 0.0;
  for (const auto& since : busy_since_) {
    if (!since) continue;
    const double age_s = std::chrono::duration<double>(now - *since).count();
    running_s += std::max(mean_job_s_, age_s);
    longest_s = std::max(longest_s, age_s);
  }
  const double others_s = mean_job_s_ > 0.0 ? mean_job_s_ : longest_s;
  const double work_s = running_s + static_cast<double>(admitted_ - running_) * others_s;
  return work_s / static_cast<double>(busy_since_.size());
}

int Workers::retry_after_s() const {
  const std::lock_guard lock(mutex_);
  return static_cast<int>(std::clamp(std::ceil(expected_wait_s()), 1.0, kMaxRetryAfterS));
}

std::size_t Workers::queued() const {
  const std::lock_guard lock(mutex_);
  return queue_.size();
}

std::size_t Workers::running() const {
  const std::lock_guard lock(mutex_);
  return running_;
}

bool Workers::Job::await_turn(const core::StopCondition& stop) {
  Workers& workers = *workers_;
  std::unique_lock lock(workers.mutex_);
  if (workers.running_ < workers.busy_since_.size()) {
    worker_ = workers.begin_turn();
    return true;
  }
  Waiting waiting;
  const auto place = workers.queue_.insert(workers.queue_.end(), &waiting);
  const auto come = [&] { return waiting.worker.has_value(); };
  // Some libraries overflow when they wait until the end of time.
  if (stop.deadline() == Clock::time_point::max()) {
    waiting.changed.wait(lock, stop.stop_token(), come);
  } else {
    waiting.changed.wait_until(lock, stop.stop_token(), stop.deadline(), come);
  }
  worker_ = waiting.worker;
  if (!worker_) workers.queue_.erase(place);
  return worker_.has_value();
}

Workers::Job::~Job() {
  if (workers_ == nullptr) return;
  const std::lock_guard lock(workers_->mutex_);
  --workers_->admitted_;
  if (worker_) workers_->end_turn(*worker_);
}

std::size_t Workers::begin_turn() {
  const auto idle = std::find(busy_since_.begin(), busy_since_.end(), std::nullopt);
  *idle = Clock::now();
  ++running_;
  return static_cast<std::size_t>(idle - busy_since_.begin());
}

void Workers::end_turn(std::size_t worker) {
  const double seconds = std::chrono::duration<double>(Clock::now() - *busy_since_[worker]).count();
  mean_job_s_ = mean_job_s_ == 0.0 ? seconds : mean_job_s_ + kNewestWeight * (seconds - mean_job_s_);
  busy_since_[worker].reset();
  --running_;
  if (!queue_.empty()) {
    Waiting& next = *queue_.front();
    queue_.pop_front();
    next.worker = begin_turn();
    next.changed.notify_one();
  } else if (may_help()) {
    may_help_.notify_one();
  }
}

void Workers::run(std::size_t count, const Task& task) {
  Tasks tasks{task, count};
  std::unique_lock lock(mutex_);
  const auto place = shared_.insert(shared_.end(), &tasks);
  for (std::size_t k = 1; k < std::min(count, busy_since_.size()); ++k) may_help_.notify_one();
  while (tasks.to_do()) do_next(tasks, lock);
  shared_.erase(place);
  tasks.none_at_hand.wait(lock, [&] { return tasks.at_hand == 0; });
  if (tasks.failure) std::rethrow_exception(tasks.failure);
}

Workers::Tasks* Workers::tasks_to_do() const {
  const auto found = std::find_if(shared_.begin(), shared_.end(), [](const Tasks* t) { return t->to_do(); });
  return found == shared_.end() ? nullptr : *found;
}

void Workers::do_next(Tasks& tasks, std::unique_lock<std::mutex>& lock) {
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

bool Workers::may_help() const {
  return running_ + helping_ < busy_since_.size() && tasks_to_do() != nullptr;
}

void Workers::help() {
  std::unique_lock lock(mutex_);
  while (true) {
    may_help_.wait(lock, [&] { return stopping_ || may_help(); });
    if (stopping_) return;
    ++helping_;
    do_next(*tasks_to_do(), lock);
    --helping_;
  }
}

}  // namespace fleetplan::server
