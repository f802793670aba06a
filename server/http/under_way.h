#pragma once

#include <atomic>
#include <cstddef>

namespace fleetplan::server {

/// Counts something as under way as long as it lives.
class UnderWay {
 public:
  explicit UnderWay(std::atomic<std::size_t>& count) : count_(count) { ++count_; }
  ~UnderWay() { --count_; }
  UnderWay(const UnderWay&) = delete;
  UnderWay& operator=(const UnderWay&) = delete;

 private:
  std::atomic<std::size_t>& count_;
};

}  // namespace fleetplan::server
