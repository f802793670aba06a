#pragma once

#include <chrono>
#include <thread>

namespace fleetplan::server {

/// True as soon as `condition` holds; false if it does not within a minute.
template <typename Condition>
bool holds_soon(const Condition& condition) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (!condition()) {
    if (std::chrono::steady_clock::now() > deadline) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return true;
}

}  // namespace fleetplan::server
