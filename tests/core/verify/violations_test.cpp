#include <gtest/gtest.h>

#include "core/verify/check_rules.h"
#include "tests/core/verify/scene.h"
#include "tests/support/plain_check.h"

namespace fleetplan::core {
namespace TEST_FILE {

Violation at(double t) { return {Kind::speed, {0}, t, 0.0, 0.0, ""}; }

TEST(ViolationList, KeepsTheFirstByTimeAndCountsAll) {
  ViolationList list;
  const std::size_t count = 3 * kMostViolations + 5;
  for (std::size_t k = 0; k < count; ++k) list.add(at(static_cast<double>(count - k)));
  EXPECT_EQ(list.total(), count);
  const auto kept = list.take();
  ASSERT_EQ(kept.size(), kMostViolations);
  EXPECT_EQ(kept.front().t, 1.0);
  EXPECT_EQ(kept.back().t, static_cast<double>(kMostViolations));
}

TEST(ViolationList, CountsThoseOfAnotherListThatItDropped) {
  ViolationList many;
  for (std::size_t k = 0; k < 2 * kMostViolations; ++k) many.add(at(0.0));
  ViolationList all;
  all.add(at(1.0));
  all.add(std::move(many));
  EXPECT_EQ(all.total(), 2 * kMostViolations + 1);
}

/// A robot that leaps to and fro between two blocked cells, much faster than it can.
RobotPlan leaps(std::size_t count) {
  RobotPlan plan;
  Pose here{Position(0.5, 0.5), 0.0};
  Pose there{Position(9.5, 0.5), 0.0};
  for (std::size_t k = 0; k < count; ++k) {
    const double t = static_cast<double>(k);
    plan.actions.push_back({Action::Type::translate, t, t + 1.0, here, there});
    std::swap(here, there);
  }
  plan.cost = static_cast<double>(count);
  return plan;
}

TEST(Verify, EndsWithinThePlanOfOneRobotWhenTheStopConditionIsMet) {
  const OccupancyGrid grid = support::ascii_map({"#........#"});
  const std::vector<Robot> robots{robot_at(0.5, 0.5)};
  const std::vector<RobotPlan> plans{leaps(400'000)};
  const StopCondition soon(StopCondition::Clock::now() + std::chrono::milliseconds(20));
  EXPECT_FALSE(verify(grid, robots, plans, kTolerance, soon));
}

TEST(Verify, ReportsABoundedNumberOfViolationsAndCountsAll) {
  const OccupancyGrid grid = support::ascii_map({"#........#"});
  const VerifyReport report =
      *verify(grid, {robot_at(0.5, 0.5)}, {leaps(30'000)}, kTolerance, StopCondition::never());
  EXPECT_EQ(report.violations.size(), kMostViolations);
  EXPECT_GE(report.violation_count, 30'000U) << "each leap is too fast";
  EXPECT_EQ(report.violations.front().t, 0.0);
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
