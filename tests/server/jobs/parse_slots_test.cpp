#include "server/jobs/parse_slots.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

namespace fleetplan::server {
namespace TEST_FILE {

using Slot = ParseSlots::Slot;

constexpr std::size_t kLarge = 10 * ParseSlots::kSmall;

const core::StopCondition kForever = core::StopCondition::never();
const core::StopCondition kNow(core::StopCondition::Clock::time_point::min());

TEST(ParseSlots, BoundHowManyBodiesAreParsed) {
  ParseSlots slots(2);
  Slot first(slots, {"client", kLarge}, kForever);
  const Slot second(slots, {"client", kLarge}, kForever);
  EXPECT_TRUE(first.has_slot() && second.has_slot());
  EXPECT_FALSE(Slot(slots, {"client", kLarge}, kNow).has_slot());
  first.release();
  EXPECT_TRUE(Slot(slots, {"client", kLarge}, kNow).has_slot());
}

TEST(ParseSlots, HaveOneMoreForSmallBodies) {
  ParseSlots slots(1);
  const Slot large(slots, {"client", kLarge}, kForever);
  Slot small(slots, {"client", ParseSlots::kSmall}, kForever);
  EXPECT_TRUE(small.has_slot());
  EXPECT_FALSE(Slot(slots, {"client", 1}, kNow).has_slot());
  small.release();
  EXPECT_TRUE(Slot(slots, {"client", 1}, kNow).has_slot());
}

TEST(ParseSlots, StopWaitingWhenTheClientLeaves) {
  ParseSlots slots(1);
  const Slot large(slots, {"client", kLarge}, kForever);
  std::stop_source leaves;
  leaves.request_stop();
  const core::StopCondition stop(core::StopCondition::Clock::time_point::max(), leaves.get_token());
  EXPECT_FALSE(Slot(slots, {"client", kLarge}, stop).has_slot());
}

/// Bodies that wait for the only slot, in the order in which they get it.
class Waiting : public testing::Test {
 protected:
  void wait(const std::string& name, const std::string& client, std::size_t bytes) {
    const std::size_t others = slots.waiting();
    threads.emplace_back([this, name, client, bytes] {
      const Slot slot(slots, {client, bytes}, kForever);
      const std::lock_guard lock(mutex);
      order.push_back(name);
    });
    while (slots.waiting() == others) std::this_thread::yield();
  }

  std::vector<std::string> served() {
    first.release();
    threads.clear();
    return order;
  }

  ParseSlots slots{1};
  Slot first{slots, {"hog", kLarge}, kForever};
  Slot small{slots, {"hog", 1}, kForever};
  std::mutex mutex;
  std::vector<std::string> order;
  std::vector<std::jthread> threads;
};

TEST_F(Waiting, GoesRoundTheClients) {
  wait("first of the hog", "hog", kLarge);
  wait("second of the hog", "hog", kLarge);
  wait("other", "other", 2 * kLarge);
  EXPECT_EQ(served().front(), "other");
}

TEST_F(Waiting, ServesTheSmallestOfThoseThatCameTogether) {
  wait("huge", "client", 1000 * kLarge);
  wait("large", "client", kLarge);
  EXPECT_EQ(served(), (std::vector<std::string>{"large", "huge"}));
}

TEST_F(Waiting, DoesNotServeSmallBodiesThatComeLater) {
  wait("large", "client", kLarge);
  std::this_thread::sleep_for(std::chrono::milliseconds(100));  // longer than it takes to parse it
  wait("later", "client", kLarge / 10);
  EXPECT_EQ(served(), (std::vector<std::string>{"large", "later"}));
}

TEST(ParseSlots, ServeEveryBodyWithoutMoreThanTheirNumber) {
  ParseSlots slots(2);
  std::atomic<int> parsing{0};
  std::atomic<int> parsed{0};
  std::vector<std::jthread> threads;
  for (int t = 0; t < 6; ++t) {
    threads.emplace_back([&, t] {
      for (int k = 0; k < 200; ++k) {
        const Slot slot(slots, {"client", t < 3 ? kLarge : 1}, kForever);
        EXPECT_LE(++parsing, 3);
        std::this_thread::yield();
        --parsing;
        ++parsed;
      }
    });
  }
  threads.clear();
  EXPECT_EQ(parsed, 1200);
}

}  // namespace TEST_FILE
}  // namespace fleetplan::server
