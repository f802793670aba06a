#include "core/runtime/memory_account.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <memory>
#include <new>
#include <thread>
#include <vector>

#include "core/runtime/stop_condition.h"

namespace fleetplan::core {
namespace TEST_FILE {

constexpr std::size_t kMiB = 1 << 20;
/// A thread's last batch, and what the allocator adds.
constexpr std::int64_t kSlack = 2 * MemoryAccount::kBatch;

std::unique_ptr<std::vector<char>> block(std::size_t bytes) {
  return std::make_unique<std::vector<char>>(bytes);
}

TEST(MemoryAccount, CountsWhatIsAllocatedLessWhatIsFreed) {
  MemoryAccount account(64 * kMiB);
  {
    const MemoryScope scope(&account);
    auto first = block(3 * kMiB);
    const auto second = block(2 * kMiB);
    EXPECT_NEAR(static_cast<double>(account.used()), 5.0 * kMiB, kSlack);
    first.reset();
    EXPECT_NEAR(static_cast<double>(account.used()), 2.0 * kMiB, kSlack);
  }
  EXPECT_NEAR(static_cast<double>(account.used()), 0.0, kSlack);
  EXPECT_NEAR(static_cast<double>(account.peak()), 5.0 * kMiB, kSlack);
}

TEST(MemoryAccount, CountsManySmallBlocks) {
  MemoryAccount account(64 * kMiB);
  const MemoryScope scope(&account);
  std::vector<std::unique_ptr<int>> blocks(100'000);
  const std::int64_t before = account.used();
  for (auto& one : blocks) one = std::make_unique<int>(7);
  EXPECT_GE(account.used() - before, static_cast<std::int64_t>(100'000 * sizeof(int)) - kSlack);
  blocks.clear();
  EXPECT_NEAR(static_cast<double>(account.used()), static_cast<double>(before), kSlack);
}

/// Calls the allocation functions, as a compiler may leave out new expressions.
TEST(MemoryAccount, CountsEveryFormOfNew) {
  constexpr std::align_val_t kAlignment{256};
  MemoryAccount account(64 * kMiB);
  const MemoryScope scope(&account);
  std::vector<void*> plain{::operator new(kMiB), ::operator new[](kMiB), ::operator new(kMiB, std::nothrow),
                           ::operator new[](kMiB, std::nothrow)};
  std::vector<void*> aligned{::operator new(kMiB, kAlignment), ::operator new[](kMiB, kAlignment),
                             ::operator new(kMiB, kAlignment, std::nothrow),
                             ::operator new[](kMiB, kAlignment, std::nothrow)};
  EXPECT_NEAR(static_cast<double>(account.used()), 8.0 * kMiB, kSlack);
  for (void* memory : plain) ::operator delete(memory);
  for (void* memory : aligned) {
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(memory) % 256, 0U);
    ::operator delete(memory, kAlignment);
  }
  EXPECT_NEAR(static_cast<double>(account.used()), 0.0, kSlack);
}

TEST(MemoryAccount, IsShortBeyondThreeQuartersOfItsLimit) {
  MemoryAccount account(8 * kMiB);
  const MemoryScope scope(&account);
  auto most = block(5 * kMiB);
  EXPECT_FALSE(account.is_short());
  EXPECT_EQ(memory_shortages(), 0);
  auto more = block(2 * kMiB);
  EXPECT_TRUE(account.is_short());
  EXPECT_TRUE(is_short_of_memory());
  more.reset();
  EXPECT_FALSE(account.is_short());
  EXPECT_EQ(memory_shortages(), 1);
}

TEST(MemoryAccount, RefusesWhatExceedsItsLimit) {
  MemoryAccount account(8 * kMiB);
  const MemoryScope scope(&account);
  const auto held = block(5 * kMiB);
  EXPECT_THROW(block(4 * kMiB), std::bad_alloc);
  EXPECT_EQ(new (std::nothrow) char[4 * kMiB], nullptr);
  EXPECT_NEAR(static_cast<double>(account.used()), 5.0 * kMiB, kSlack);
  EXPECT_EQ(memory_shortages(), 2);
  EXPECT_NO_THROW(block(2 * kMiB));
}

TEST(MemoryAccount, IsNotChargedByThreadsOutsideOfItsScopes) {
  MemoryAccount account(8 * kMiB);
  const MemoryScope scope(&account);
  std::thread([] { EXPECT_NO_THROW(block(16 * kMiB)); }).join();
  EXPECT_NEAR(static_cast<double>(account.used()), 0.0, kSlack);
}

TEST(MemoryAccount, AddsUpTheThreadsOfAJob) {
  MemoryAccount account(64 * kMiB);
  std::vector<std::thread> threads;
  for (int k = 0; k < 4; ++k) {
    threads.emplace_back([&] {
      const MemoryScope scope(&account);
      for (int round = 0; round < 1000; ++round) block(100);
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_NEAR(static_cast<double>(account.used()), 0.0, kSlack);
}

TEST(MemoryScope, ReturnsToTheAccountAroundIt) {
  MemoryAccount outer(64 * kMiB);
  MemoryAccount inner(64 * kMiB);
  const MemoryScope scope(&outer);
  const auto first = block(kMiB);
  {
    const MemoryScope nested(&inner);
    block(2 * kMiB);
    const MemoryScope nobody(nullptr);
    block(4 * kMiB);
  }
  EXPECT_EQ(MemoryScope::current(), &outer);
  const auto second = block(kMiB);
  EXPECT_NEAR(static_cast<double>(outer.peak()), 2.0 * kMiB, kSlack);
  EXPECT_NEAR(static_cast<double>(inner.peak()), 2.0 * kMiB, kSlack);
}

TEST(StopCondition, IsMetWhileTheJobIsShortOfMemory) {
  MemoryAccount account(8 * kMiB);
  const MemoryScope scope(&account);
  const StopCondition stop(StopCondition::Clock::time_point::max());
  EXPECT_FALSE(stop.met());
  auto most = block(7 * kMiB);
  EXPECT_TRUE(stop.met());
  EXPECT_FALSE(StopCondition::never().met()) << "what has to be completed uses it";
  EXPECT_FALSE(stop.cancelled());
  most.reset();
  EXPECT_FALSE(stop.met());
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
