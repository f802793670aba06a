#include "tests/bench/comparison.h"

#include <gtest/gtest.h>

#include <cmath>

namespace fleetplan::bench {
namespace {

Result result(const std::string& file, std::size_t robots, double seconds, std::optional<double> flowtime) {
  return {file, robots, flowtime.has_value(), 1, seconds, flowtime, flowtime};
}

Measurement ours(const std::string& file, std::size_t robots, double seconds,
                 std::optional<double> flowtime) {
  Measurement made;
  made.result = result(file, robots, seconds, flowtime);
  return made;
}

TEST(Comparison, PairsRunsByFileAndNumberOfRobots) {
  const Comparison comparison =
      compare({ours("a", 60, 1.0, 90.0), ours("a", 120, 2.0, 300.0), ours("b", 60, 1.0, 1.0)},
              {result("a", 120, 8.0, 200.0), result("a", 60, 2.0, 100.0)});
  ASSERT_EQ(comparison.rows.size(), 2u) << "b is not in the reference";
  EXPECT_EQ(comparison.rows[0].speedup, 2.0);
  EXPECT_EQ(comparison.rows[0].flowtime_ratio, 0.9);
  EXPECT_EQ(comparison.rows[1].speedup, 4.0);
  EXPECT_EQ(comparison.rows[1].flowtime_ratio, 1.5);
  EXPECT_EQ(comparison.smallest_speedup, 2.0);
  EXPECT_DOUBLE_EQ(comparison.mean_speedup.value(), std::sqrt(8.0));
  EXPECT_DOUBLE_EQ(comparison.mean_flowtime_ratio.value(), 1.2);
  EXPECT_EQ(comparison.largest_flowtime_ratio, 1.5);
}

TEST(Comparison, CountsSpeedUpsOnlyWhereTheReferenceTookLongEnough) {
  const Comparison comparison =
      compare({ours("short", 9, 0.1, 10.0), ours("long", 9, 0.1, 10.0)},
              {result("short", 9, 0.199, 10.0), result("long", 9, kShortestReference, 10.0)});
  EXPECT_EQ(comparison.counted, 1u);
  EXPECT_EQ(comparison.smallest_speedup, 2.0);
  EXPECT_TRUE(comparison.rows[0].speedup) << "it is told all the same";
}

TEST(Comparison, TakesRatiosOnlyWhereBothSolvedAndTellsWhatWasLost) {
  const Comparison comparison =
      compare({ours("lost", 9, 60.0, {}), ours("won", 9, 1.0, 10.0), ours("neither", 9, 60.0, {})},
              {result("lost", 9, 1.0, 5.0), result("won", 9, 60.0, {}), result("neither", 9, 60.0, {})});
  EXPECT_EQ(comparison.solved_by_us, 1u);
  EXPECT_EQ(comparison.solved_by_reference, 1u);
  EXPECT_EQ(comparison.lost, 1u);
  EXPECT_EQ(comparison.counted, 0u);
  EXPECT_FALSE(comparison.mean_speedup);
  EXPECT_FALSE(comparison.mean_flowtime_ratio);
  for (const ComparedRow& row : comparison.rows) EXPECT_FALSE(row.speedup);
}

}  // namespace
}  // namespace fleetplan::bench
