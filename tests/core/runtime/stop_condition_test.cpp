#include "core/runtime/stop_condition.h"

#include <gtest/gtest.h>

#include <utility>

#include "core/runtime/shared_turn.h"
#include "tests/support/step_limit.h"

namespace fleetplan::core {
namespace TEST_FILE {

using Clock = StopCondition::Clock;

TEST(StopCondition, IsNeverMetByDefault) {
  EXPECT_FALSE(StopCondition::never().met());
  EXPECT_FALSE(StopCondition::never().cancelled());
  EXPECT_EQ(StopCondition::never().deadline(), Clock::time_point::max());
}

TEST(StopCondition, IsMetOnceItsDeadlineHasPassed) {
  EXPECT_TRUE(StopCondition(Clock::now() - std::chrono::seconds(1)).met());
  EXPECT_FALSE(StopCondition(Clock::now() - std::chrono::seconds(1)).cancelled());
  EXPECT_FALSE(StopCondition(Clock::now() + std::chrono::hours(1)).met());
}

TEST(StopCondition, HasItsCpuTimeHoweverLateItIs) {
  constexpr std::chrono::milliseconds kLeast{5};
  std::stop_source source;
  const StopCondition late(Clock::now() - std::chrono::seconds(1), source.get_token());
  const auto begin = thread_cpu_time();
  const StopCondition stop = late.with_cpu_time(kLeast);
  while (!stop.met()) EXPECT_LT(thread_cpu_time() - begin, std::chrono::minutes(1));
  EXPECT_GE(thread_cpu_time() - begin, kLeast);
  EXPECT_TRUE(stop.is_over());
  const StopCondition other = late.with_cpu_time(std::chrono::hours(1));
  EXPECT_FALSE(other.met());
  source.request_stop();
  EXPECT_TRUE(other.met());
}

TEST(StopStride, AsksAtTheStepThatCompletesEachStride) {
  support::StepLimit limit;
  const StopCondition stop = support::counted(limit);
  StopStride stride(stop, 4);
  for (const int questions : {0, 0, 0, 1, 1, 1, 1, 2}) {
    EXPECT_FALSE(stride.met_at_step());
    EXPECT_EQ(limit.steps(), questions);
  }
}

TEST(StopStride, AsksAtTheFirstStepIfThatIsWanted) {
  support::StepLimit limit;
  const StopCondition stop = support::counted(limit);
  StopStride stride = StopStride::from_first(stop, 3);
  EXPECT_EQ(limit.steps(), 0);
  for (const int questions : {1, 1, 1, 2, 2, 2, 3}) {
    EXPECT_FALSE(stride.met_at_step());
    EXPECT_EQ(limit.steps(), questions);
  }
}

TEST(StopStride, AsksOnceForAStepThatCountsAsMany) {
  support::StepLimit limit;
  const StopCondition stop = support::counted(limit);
  StopStride stride(stop, 10);
  for (const auto& [steps, questions] : {std::pair{9, 0}, {1, 1}, {35, 2}, {0, 2}, {9, 2}, {2, 3}}) {
    EXPECT_FALSE(stride.met_after(static_cast<std::size_t>(steps)));
    EXPECT_EQ(limit.steps(), questions) << "after " << steps;
  }
}

TEST(StopStride, StaysMetAndAsksNoMore) {
  support::StepLimit limit(1);
  const StopCondition stop = support::counted(limit);
  StopStride stride(stop, 2);
  EXPECT_FALSE(stride.met_at_step());
  EXPECT_FALSE(stride.met_at_step());
  EXPECT_FALSE(stride.met_at_step());
  EXPECT_FALSE(stride.met());
  EXPECT_TRUE(stride.met_at_step());
  EXPECT_TRUE(stride.met());
  for (int k = 0; k < 5; ++k) EXPECT_TRUE(stride.met_at_step());
  EXPECT_EQ(limit.steps(), 2);
}

TEST(SharedTurn, EndsConditionsThatDoNotOutlastIt) {
  bool goes_on = true;
  int asked = 0;
  SharedTurn turn(StopCondition(Clock::now() + std::chrono::hours(1)), [&] {
    ++asked;
    return goes_on;
  });
  const StopCondition stop = turn.stop();
  EXPECT_FALSE(stop.met());
  EXPECT_EQ(asked, 1);
  EXPECT_FALSE(stop.met());
  EXPECT_LE(asked, 2) << "not at every question";
  goes_on = false;
  EXPECT_FALSE(turn.share());
  EXPECT_TRUE(stop.met());
  EXPECT_TRUE(stop.is_over());
  EXPECT_TRUE(stop.until(Clock::now() + std::chrono::minutes(1)).met());
  const int so_far = asked;
  EXPECT_FALSE(stop.until(Clock::now() + std::chrono::hours(2)).met()) << "for what is done at the end";
  EXPECT_FALSE(stop.even_if_cancelled(Clock::now() + std::chrono::minutes(1)).met());
  EXPECT_EQ(asked, so_far);
}

TEST(SharedTurn, IsMetWithTheConditionItIsMadeOf) {
  support::StepLimit limit(1);
  SharedTurn early(support::counted(limit), {});
  SharedTurn late(StopCondition(Clock::now() - std::chrono::seconds(1)), {});
  EXPECT_TRUE(late.stop().met());
  const StopCondition stop = early.stop().until(Clock::now() + std::chrono::hours(1));
  EXPECT_FALSE(stop.met());
  EXPECT_TRUE(stop.met());
}

TEST(StopCondition, IsMetOnceAStopIsRequested) {
  std::stop_source source;
  const StopCondition stop(Clock::now() + std::chrono::hours(1), source.get_token());
  EXPECT_FALSE(stop.met());
  source.request_stop();
  EXPECT_TRUE(stop.met());
  EXPECT_TRUE(stop.cancelled());
}

TEST(StopCondition, IsMetAfterTheStepsOfATest) {
  support::StepLimit limit(2);
  const StopCondition forever(Clock::time_point::max());
  const StopCondition stop = forever.ended_by(&limit);
  EXPECT_FALSE(stop.met());
  EXPECT_FALSE(stop.met());
  EXPECT_TRUE(stop.met());
  EXPECT_FALSE(StopCondition::never().ended_by(&limit).met());
  EXPECT_EQ(limit.steps(), 3);
  EXPECT_FALSE(forever.met());
}

TEST(StopCondition, IsMetLaterByStepsIfItOutlastsTheBudget) {
  const Clock::time_point end = Clock::now() + std::chrono::hours(1);
  support::StepLimit limit(1, 2);
  const StopCondition unlimited(end);
  const StopCondition stop = unlimited.ended_by(&limit);
  const StopCondition check = stop.until(end + std::chrono::hours(1));
  EXPECT_FALSE(stop.is_over());
  EXPECT_FALSE(stop.met());
  EXPECT_TRUE(stop.is_over());
  EXPECT_TRUE(stop.met());
  EXPECT_TRUE(stop.until(end - std::chrono::minutes(1)).is_over());
  EXPECT_FALSE(check.is_over());
  EXPECT_FALSE(check.met());
  EXPECT_TRUE(check.met());
  EXPECT_TRUE(stop.even_if_cancelled(end).met());
  EXPECT_FALSE(unlimited.until(end + std::chrono::hours(1)).met());
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
