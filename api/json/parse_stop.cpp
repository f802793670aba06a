#include "api/json/parse_stop.h"

#include <algorithm>
#include <ctime>
#include <utility>

namespace fleetplan::api {

ParseStop::ParseStop(std::stop_token stop, Clock::time_point received_at, CpuClock cpu_clock)
    : stop_(std::move(stop)),
      received_at_(received_at),
      cpu_clock_(std::move(cpu_clock)),
      cpu_end_(cpu_clock_() + kMostCpu) {}

void ParseStop::set_budget(std::chrono::nanoseconds budget) {
  if (received_at_ == Clock::time_point::max()) return;
  cpu_clock_ = nullptr;
  deadline_ = std::max(received_at_ + budget, Clock::now()) + kGrace;
}

bool ParseStop::look() {
  work_ = 0;
  met_ = met_ || cancelled() || (cpu_clock_ && cpu_clock_() >= cpu_end_) || Clock::now() >= deadline_;
  return met_;
}

std::chrono::nanoseconds ParseStop::thread_cpu_time() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return std::chrono::seconds(time.tv_sec) + std::chrono::nanoseconds(time.tv_nsec);
}

}  // namespace fleetplan::api
