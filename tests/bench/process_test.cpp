#include "tests/bench/process.h"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>
#include <vector>

namespace fleetplan::bench {
namespace TEST_FILE {

TEST(Process, CountsCpuTimeOfWorkAndNotOfSleep) {
  const double before = thread_cpu_seconds();
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  const double slept = thread_cpu_seconds();
  EXPECT_LT(slept - before, 0.045);
  while (thread_cpu_seconds() < slept + 0.01) {
  }
  EXPECT_GE(thread_cpu_seconds() - slept, 0.01);
}

TEST(Process, ReportsThePeakOfMemory) {
  constexpr std::size_t kSize = 64u << 20;
  forget_peak_memory();
  const std::size_t before = peak_memory();
  EXPECT_GT(before, 0u);
  {
    const std::vector<char> block(kSize, 'x');
    EXPECT_EQ(block.back(), 'x');
  }
  EXPECT_GE(peak_memory(), before + kSize / 2);
}

}  // namespace TEST_FILE
}  // namespace fleetplan::bench
