#include "tests/bench/process.h"

#include <malloc.h>

#include <ctime>
#include <fstream>
#include <string>

namespace fleetplan::bench {

double thread_cpu_seconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

std::size_t peak_memory() {
  std::ifstream status("/proc/self/status");
  for (std::string name; status >> name;) {
    std::size_t kib = 0;
    if (name == "VmHWM:" && status >> kib) return kib * 1024;
  }
  return 0;
}

void forget_peak_memory() {
  malloc_trim(0);
  constexpr char kResetPeak = '5';  // man 5 proc, clear_refs
  std::ofstream("/proc/self/clear_refs") << kResetPeak;
}

}  // namespace fleetplan::bench
