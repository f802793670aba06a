#include "tests/bench/lifelong/lifelong.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

namespace fleetplan::bench {
namespace TEST_FILE {

LifelongJob job(const char* strategy, std::uint64_t seed = 1) {
  const nlohmann::json line = {{"name", strategy},
                               {"strategy", strategy},
                               {"shelves", {2, 3}},
                               {"robots", 6},
                               {"seconds", 120},
                               {"seed", seed},
                               {"budget_ms", 10'000},
                               {"commit", 0.5},
                               {"halt", 0.0},
                               {"clock", "none"},
                               {"options", {{"start_safe_interval", 0}, {"replan", "where_needed"}}}};
  return parse_lifelong_job(line.dump());
}

/// A simulation in which planning takes no time, so it is the same in slow builds and on busy machines.
LifelongResult run(const char* strategy, std::uint64_t seed = 1) {
  const LifelongResult result = simulate(job(strategy, seed));
  EXPECT_EQ(result.fault, "");
  EXPECT_EQ(result.unplanned, 0u);
  EXPECT_GE(result.robot_seconds, 6 * 120.0);
  EXPECT_GT(result.tasks, 6u);
  EXPECT_LE(result.lone_seconds, result.robot_seconds);
  EXPECT_LE(result.moving_seconds + result.service_seconds, result.robot_seconds);
  EXPECT_EQ(result.latencies.size(), result.replans);
  return result;
}

TEST(Lifelong, ServesOverRoundsWithAHorizon) {
  LifelongJob with_horizon = job("committed");
  with_horizon.planning = {{"start_safe_interval", 0}, {"horizon", 8}};
  const LifelongResult result = simulate(with_horizon);
  EXPECT_EQ(result.fault, "");
  EXPECT_EQ(result.unplanned, 0u);
  EXPECT_GT(result.tasks, 6u);
  EXPECT_LE(result.lone_seconds, result.robot_seconds);
}

TEST(Lifelong, ServesMoreWithSnapshotsThanWhenTheWorldStops) {
  const LifelongResult stopped = run("stop");
  const LifelongResult snapshots = run("snapshots");
  EXPECT_EQ(stopped.under_way, 0u);
  EXPECT_GT(snapshots.under_way, snapshots.replans);
  EXPECT_GT(snapshots.tasks, stopped.tasks);
  EXPECT_GT(snapshots.replans, stopped.replans);
}

TEST(Lifelong, ChangesNoPlanOfARobotUnderWayThatHolds) {
  constexpr std::uint64_t kSeeds = 8;  // one of them serves 5 % more or less by chance
  std::size_t served = 0;
  std::size_t served_from_snapshots = 0;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const LifelongResult committed = run("committed", seed);
    EXPECT_GT(committed.under_way, committed.replans);
    EXPECT_LE(committed.changed * 20, committed.under_way);
    served += committed.tasks;
    served_from_snapshots += run("snapshots", seed).tasks;
  }
  EXPECT_GE(served + 2 * kSeeds, served_from_snapshots);
}

TEST(Lifelong, TakesJobsOnly) {
  EXPECT_THROW(parse_lifelong_job("{}"), std::runtime_error);
  EXPECT_THROW(parse_lifelong_job("no"), std::runtime_error);
}

TEST(Lifelong, HasAValueForEveryColumn) {
  const std::string header = lifelong_csv_header();
  const std::string row =
      lifelong_csv_row(job("stop"), {3, 720.0, 360.0, 300.0, 60.0, 2, 4, 1, 0, 0, {0.5}, ""});
  EXPECT_EQ(std::count(header.begin(), header.end(), ','), std::count(row.begin(), row.end(), ','));
  EXPECT_THAT(row, testing::StartsWith("\"stop\",6,120.000000,3,0.500000,15.000000,0.500000,2,0.250000,"));
}

}  // namespace TEST_FILE
}  // namespace fleetplan::bench
