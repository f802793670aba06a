#include "core/runtime/stop_condition.h"

#include <algorithm>
#include <ctime>
#include <utility>

namespace fleetplan::core {

std::chrono::nanoseconds thread_cpu_time() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return std::chrono::seconds(time.tv_sec) + std::chrono::nanoseconds(time.tv_nsec);
}

Work::Work(Bounds bounds)
    : bounds_(std::move(bounds)),
      memory_(std::make_shared<MemoryAccount>(bounds_.memory)),
      is_bounded_(true),
      cpu_begin_(bounds_.cpu_clock()),
      cpu_end_(cpu_begin_ + kMaxCpu) {}

void Work::set_budget(std::chrono::nanoseconds budget) {
  if (!is_bounded_) return;
  budget_ = budget;
  cpu_end_ = cpu_begin_ + kMaxCpuOfReading;
  deadline_ = std::max(bounds_.received_at + budget, Clock::now()) + kGrace;
}

void Work::end_reading() {
  if (budget_) cpu_end_.reset();
}

bool Work::look() {
  amount_ = 0;
  if (!is_bounded_) return false;
  met_ = met_ || (bounds_.early_end != nullptr && bounds_.early_end->met(false)) || cancelled() ||
         (cpu_end_ && bounds_.cpu_clock() >= *cpu_end_) || Clock::now() >= deadline_;
  return met_;
}

StopCondition Work::before_end(std::chrono::nanoseconds kept) const {
  return until(budget_ ? bounds_.received_at + *budget_ - kept : Clock::time_point::max());
}

}  // namespace fleetplan::core
