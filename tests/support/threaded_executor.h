#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <thread>
#include <vector>

#include "core/runtime/executor.h"

namespace fleetplan::support {

/// Runs tasks on threads that are started for each run.
class ThreadedExecutor : public core::Executor {
 public:
  explicit ThreadedExecutor(std::size_t threads) : threads_(threads) {}

  void run_on(std::size_t max_threads, std::size_t count, const Task& task) override {
    std::atomic<std::size_t> next{0};
    std::vector<std::jthread> threads;
    for (std::size_t t = 0; t < std::min(threads_, max_threads); ++t) {
      threads.emplace_back([&] {
        for (std::size_t k = next++; k < count; k = next++) task(k);
      });
    }
  }

 private:
  std::size_t threads_;
};

}  // namespace fleetplan::support
