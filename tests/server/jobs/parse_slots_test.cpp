#include "server/jobs/parse_slots.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <deque>
#include <map>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

namespace fleetplan::server {
namespace TEST_FILE {

using Slot = ParseSlots::Slot;

constexpr std::size_t kLarge = 10 * ParseSchedule::kSmall;

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
  Slot small(slots, {"client", ParseSchedule::kSmall}, kForever);
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
  Waiting() {
    hog_slot = schedule.take(hog);
    schedule.take(small_of_hog);
  }

  void wait(const std::string& name, const std::string& client, std::size_t bytes, int arrived_ms = 0) {
    const auto& body = bodies.emplace_back(ParseSlots::Body{client, bytes});
    const ParseSchedule::Time arrived{std::chrono::milliseconds(arrived_ms)};
    ASSERT_EQ(schedule.take(body), Kind::none);
    schedule.wait(waiting.emplace_back(body, arrived));
    names.emplace(&waiting.back(), name);
  }

  std::vector<std::string> served() {
    std::vector<std::string> order;
    auto* next = schedule.give_back(hog_slot, hog);
    for (; next != nullptr; next = schedule.give_back(next->slot, next->body)) {
      EXPECT_EQ(next->slot, Kind::any);
      order.push_back(names.at(next));
    }
    return order;
  }

  using Kind = ParseSchedule::Kind;
  ParseSchedule schedule{1};
  const ParseSlots::Body hog{"hog", kLarge};
  const ParseSlots::Body small_of_hog{"hog", 1};
  Kind hog_slot = Kind::none;
  std::deque<ParseSlots::Body> bodies;
  std::deque<ParseSchedule::Waiting> waiting;
  std::map<const ParseSchedule::Waiting*, std::string> names;
};

TEST_F(Waiting, GoesRoundTheClients) {
  wait("first of the hog", "hog", kLarge);
  wait("second of the hog", "hog", kLarge);
  wait("other", "other", 2 * kLarge);
  EXPECT_EQ(served(), (std::vector<std::string>{"other", "first of the hog", "second of the hog"}));
}

TEST_F(Waiting, ServesTheSmallestOfThoseThatCameTogether) {
  wait("huge", "client", 1000 * kLarge);
  wait("large", "client", kLarge);
  EXPECT_EQ(served(), (std::vector<std::string>{"large", "huge"}));
}

TEST_F(Waiting, DoesNotServeSmallBodiesThatComeLater) {
  wait("large", "client", kLarge);
  wait("later", "client", kLarge / 10, 100);  // after longer than it takes to parse the large one
  EXPECT_EQ(served(), (std::vector<std::string>{"large", "later"}));
}

TEST_F(Waiting, LeavesOutBodiesThatNobodyWaitsForAnyMore) {
  wait("first", "client", kLarge);
  wait("second", "client", 2 * kLarge);
  schedule.stop_waiting(waiting.front());
  EXPECT_EQ(served(), std::vector<std::string>{"second"});
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
