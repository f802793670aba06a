#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <list>
#include <mutex>
#include <thread>
#include <utility>

#include "server/http/library/http_library.h"

namespace fleetplan::server {

/// A thread for every connection, up to a limit beyond which connections wait. Threads are started on demand
/// and end when they have been idle for a while, so idle keep-alive sockets never block others.
class ConnectionThreads final : public httplib::TaskQueue {
 public:
  explicit ConnectionThreads(std::size_t max_threads) : max_threads_(max_threads) {}
  ~ConnectionThreads() override;

  // The library's return type is void in some versions and bool in others.
  using EnqueueResult =
      decltype(std::declval<httplib::TaskQueue&>().enqueue(std::declval<std::function<void()>>()));
  EnqueueResult enqueue(std::function<void()> task) override {
    push(std::move(task));
    return EnqueueResult(true);
  }

  /// Runs all tasks that were added and ends all threads.
  void shutdown() override;

 private:
  using Threads = std::list<std::thread>;

  void push(std::function<void()> task);
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
