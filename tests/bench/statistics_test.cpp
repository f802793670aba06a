#include "tests/bench/statistics.h"

#include <gtest/gtest.h>

#include "tests/bench/summary.h"

namespace fleetplan::bench {
namespace {

TEST(Statistics, OfNothingAreNothing) {
  EXPECT_FALSE(minimum({}));
  EXPECT_FALSE(maximum({}));
  EXPECT_FALSE(mean({}));
  EXPECT_FALSE(geometric_mean({}));
  EXPECT_FALSE(percentile({}, 0.5));
  EXPECT_FALSE(median({}));
}

TEST(Statistics, FindTheExtremesInAnyOrder) {
  EXPECT_EQ(minimum({3.0, -1.0, 2.0}), -1.0);
  EXPECT_EQ(maximum({3.0, -1.0, 2.0}), 3.0);
}

TEST(Statistics, MeansAreArithmeticAndGeometric) {
  EXPECT_DOUBLE_EQ(mean({1.0, 2.0, 6.0}).value(), 3.0);
  EXPECT_DOUBLE_EQ(geometric_mean({1.0, 10.0, 100.0}).value(), 10.0);
  EXPECT_DOUBLE_EQ(geometric_mean({0.5, 2.0}).value(), 1.0);
}

TEST(Statistics, TheMedianIsTheMiddleOrHalfwayBetweenTheTwoMiddleOnes) {
  EXPECT_EQ(median({5.0}), 5.0);
  EXPECT_EQ(median({9.0, 1.0, 5.0}), 5.0);
  EXPECT_EQ(median({9.0, 1.0, 5.0, 6.0}), 5.5);
}

TEST(Statistics, PercentilesAreLinearBetweenNeighbours) {
  const std::vector<double> values{40.0, 10.0, 30.0, 20.0, 50.0};
  EXPECT_EQ(percentile(values, 0.0), 10.0);
  EXPECT_EQ(percentile(values, 0.25), 20.0);
  EXPECT_DOUBLE_EQ(percentile(values, 0.9).value(), 46.0);
  EXPECT_EQ(percentile(values, 1.0), 50.0);
}

Measurement run(std::size_t robots, double seconds, std::optional<double> flowtime) {
  Measurement made;
  made.result.robots = robots;
  made.result.seconds = seconds;
  made.result.solved = flowtime.has_value();
  made.result.flowtime = flowtime;
  if (!flowtime) return made;
  made.result.makespan = *flowtime / 10.0;
  made.lower_bound = 100.0;
  return made;
}

TEST(Summary, TakesTimesOfAllRunsAndCostsOfThoseThatWereSolved) {
  const auto summaries = summarise({run(30, 60.0, {}), run(30, 1.0, 110.0), run(30, 2.0, 150.0)});
  ASSERT_EQ(summaries.size(), 1u);
  const Summary& summary = summaries.front();
  EXPECT_EQ(summary.robots, 30u);
  EXPECT_EQ(summary.runs, 3u);
  EXPECT_EQ(summary.solved, 2u);
  EXPECT_DOUBLE_EQ(summary.success_rate(), 2.0 / 3.0);
  EXPECT_EQ(summary.median_seconds, 2.0);
  EXPECT_DOUBLE_EQ(summary.percentile_90_seconds.value(), 48.4);
  EXPECT_EQ(summary.largest_seconds, 60.0);
  EXPECT_DOUBLE_EQ(summary.flowtime.value(), 130.0);
  EXPECT_DOUBLE_EQ(summary.makespan.value(), 13.0);
  EXPECT_DOUBLE_EQ(summary.flowtime_by_bound.value(), 1.3);
}

TEST(Summary, IsMadeForEveryNumberOfRobotsAscending) {
  const auto summaries = summarise({run(60, 1.0, 120.0), run(15, 1.0, 120.0), run(60, 1.0, {})});
  ASSERT_EQ(summaries.size(), 2u);
  EXPECT_EQ(summaries[0].robots, 15u);
  EXPECT_EQ(summaries[1].robots, 60u);
  EXPECT_EQ(summaries[1].success_rate(), 0.5);
}

TEST(Summary, OfNothingSolvedHasNoCosts) {
  const auto summaries = summarise({run(300, 60.0, {})});
  ASSERT_EQ(summaries.size(), 1u);
  EXPECT_EQ(summaries[0].success_rate(), 0.0);
  EXPECT_FALSE(summaries[0].flowtime);
  EXPECT_FALSE(summaries[0].flowtime_by_bound);
}

}  // namespace
}  // namespace fleetplan::bench
