#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <list>
#include <mutex>
#include <thread>

namespace fleetplan::server {

/// The threads of requests: one for every request that is being read or answered, up to a limit beyond which
/// requests wait. Threads are started on demand and end when they have been idle for a while.
class RequestThreads {
 public:
  explicit RequestThreads(std::size_t max_threads) : max_threads_(max_threads) {}
  ~RequestThreads();
  RequestThreads(const RequestThreads&) = delete;
  RequestThreads& operator=(const RequestThreads&) = delete;

  /// Adds a task. Throws when not even one thread can be started.
  void push(std::function<void()> task);

  /// Runs all tasks that were added and ends all threads.
  void shutdown();

 private:
  using Threads = std::list<std::thread>;

  void work(Threads::iterator self);
  void reap();

  const std::size_t max_threads_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::function<void()>> tasks_;
  Threads threads_;
  Threads ended_;  // left their loop, to be joined
  std::size_t idle_ = 0;
  bool stopping_ = false;
};

}  // namespace fleetplan::server
