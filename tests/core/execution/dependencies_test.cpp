#include "core/execution/dependencies.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <optional>
#include <string>

#include "tests/support/plan_builder.h"
#include "tests/support/step_limit.h"

namespace fleetplan::core {
namespace TEST_FILE {

using support::PlanBuilder;

constexpr double kRadius = 0.5;

Robot robot(const std::string& id, double x, double y, double theta = 0.0) {
  Robot robot{id, kRadius, 1.0, 2.0, {{x, y}, theta}, Goal{{x, y}, {}}};
  return robot;
}

DependencyRules rules(std::size_t robots, double margin = 0.0) {
  return {std::vector<double>(robots, margin), 0.1, 0.0};
}

Dependencies made(const std::vector<Robot>& robots, const std::vector<RobotPlan>& plans,
                  const DependencyRules& rules) {
  return *make_dependencies(robots, plans, rules, StopCondition::never());
}

std::optional<Dependencies> made_or_none(const std::vector<Robot>& robots,
                                         const std::vector<RobotPlan>& plans, double slack) {
  return make_dependencies(robots, plans, {std::vector<double>(robots.size(), 0.0), slack, 0.0},
                           StopCondition::never());
}

/// `a` drives along x through the origin, `b` along y, so much later.
std::vector<RobotPlan> crossing(const std::vector<Robot>& robots, double later) {
  return {PlanBuilder(0, robots[0]).translate_to(5, 0).build(),
          PlanBuilder(1, robots[1]).wait(later).translate_to(0, 5).build()};
}

std::vector<Robot> crossing_robots() { return {robot("a", -5, 0), robot("b", 0, -5, M_PI_2)}; }

TEST(MakeDependencies, OfACrossingIsOne) {
  const auto robots = crossing_robots();
  const Dependencies found = made(robots, crossing(robots, 4.0), rules(2));
  ASSERT_EQ(found.list.size(), 1U);
  EXPECT_TRUE(found.tight.empty());
  const Dependency& one = found.list[0];
  EXPECT_EQ(one.gate.robot, 1U);
  EXPECT_EQ(one.gate.action, 1U);
  EXPECT_NEAR(one.gate.fraction, 0.4, 1e-9);  // a metre before the centre
  EXPECT_EQ(one.until.robot, 0U);
  EXPECT_EQ(one.until.action, 0U);
  EXPECT_NEAR(one.until.fraction, 0.6, 1e-9);
  EXPECT_NEAR(one.slack, 2.0, 1e-9);
}

TEST(MakeDependencies, AreNoneForRobotsThatNeverMeet) {
  const std::vector<Robot> robots{robot("a", 0, 0), robot("b", 0, 2)};
  const std::vector<RobotPlan> plans{PlanBuilder(0, robots[0]).translate_to(5, 0).build(),
                                     PlanBuilder(1, robots[1]).translate_to(5, 2).build()};
  EXPECT_TRUE(made(robots, plans, rules(2)).list.empty());
}

TEST(MakeDependencies, OfFollowersAreAsManyAsTheirWayHasSlacks) {
  const std::vector<Robot> robots{robot("a", 0, 0), robot("b", -3, 0)};
  const std::vector<RobotPlan> plans{PlanBuilder(0, robots[0]).translate_to(20, 0).build(),
                                     PlanBuilder(1, robots[1]).translate_to(17, 0).build()};
  // b is two seconds behind where it may be: each step is good for 1.9 of the 17 seconds until a rests.
  const Dependencies found = made(robots, plans, rules(2));
  EXPECT_TRUE(found.tight.empty());
  EXPECT_GE(found.list.size(), 9U);
  EXPECT_LE(found.list.size(), 10U);
  for (const Dependency& one : found.list) {
    EXPECT_EQ(one.gate.robot, 1U);
    EXPECT_GE(one.slack, 0.1 - 1e-9);
  }
}

TEST(MakeDependencies, ListRobotsThatTouchAsTight) {
  const auto robots = crossing_robots();
  // So that the disks just touch on their way.
  const Dependencies found = made(robots, crossing(robots, std::sqrt(2.0)), rules(2));
  ASSERT_EQ(found.tight.size(), 1U);
  EXPECT_EQ(found.tight[0].first, 0U);
  EXPECT_EQ(found.tight[0].second, 1U);
  EXPECT_LT(found.tight[0].slack, 0.1);
  for (const Dependency& one : found.list) EXPECT_GT(one.slack, 0.0);
}

TEST(MakeDependencies, KeepTheMargins) {
  const auto robots = crossing_robots();
  const Dependencies found = made(robots, crossing(robots, 4.0), rules(2, 0.25));
  ASSERT_EQ(found.list.size(), 1U);
  EXPECT_NEAR(found.list[0].gate.fraction, 0.35, 1e-9);
  EXPECT_NEAR(found.list[0].until.fraction, 0.65, 1e-9);
}

TEST(MakeDependencies, ListPairsThatArePlannedNearerThanTheMargins) {
  const std::vector<Robot> robots{robot("a", 0, 0), robot("b", 0, 1.2)};
  const std::vector<RobotPlan> plans{PlanBuilder(0, robots[0]).translate_to(5, 0).build(), {1, 0.0, {}}};
  const Dependencies found = made(robots, plans, rules(2, 0.25));
  ASSERT_EQ(found.tight.size(), 1U);
  EXPECT_EQ(found.tight[0].slack, 0.0);
}

TEST(MakeDependencies, LeaveOutWhatOthersImply) {
  // c crosses the lane of a and b, which follow each other at a distance. It must wait only for b, because b
  // waits for a beyond the crossing.
  const std::vector<Robot> robots{robot("a", 0, 0), robot("b", -3, 0), robot("c", 5, -5, M_PI_2)};
  const std::vector<RobotPlan> plans{PlanBuilder(0, robots[0]).translate_to(20, 0).build(),
                                     PlanBuilder(1, robots[1]).translate_to(17, 0).build(),
                                     PlanBuilder(2, robots[2]).wait(9.0).translate_to(5, 5).build()};
  const Dependencies found = made(robots, plans, rules(3));
  int of_c = 0;
  for (const Dependency& one : found.list) {
    if (one.gate.robot != 2) continue;
    ++of_c;
    EXPECT_EQ(one.until.robot, 1U);
  }
  EXPECT_EQ(of_c, 1);
}

TEST(MakeDependencies, OfALoadThatIsPutDownNeedTheSpaceThatIsThenTaken) {
  auto robots = crossing_robots();
  robots[0].radius = 0.2;
  robots[0].via = {Goal{{-5, 0}, {}}};
  robots[0].via[0].radius_after = 1.0;
  const Dependencies found = made(robots, crossing(robots, 6.0), rules(2));
  ASSERT_EQ(found.list.size(), 1U);
  EXPECT_NEAR(found.list[0].gate.fraction, 0.35, 1e-9);  // a metre and a half before the centre
}

/// Two robots that go to and fro beside each other, one a little later.
struct Neighbours {
  explicit Neighbours(int trips) {
    PlanBuilder a(0, robots[0]);
    PlanBuilder b(1, robots[1]);
    b.wait(1.0);
    for (int k = 0; k < trips; ++k) {
      a.translate_to(8, 0).translate_to(0, 0);
      b.translate_to(8, 1.1).translate_to(0, 1.1);
    }
    plans = {a.build(), b.build()};
  }

  std::vector<Robot> robots{robot("a", 0, 0), robot("b", 0, 1.1)};
  std::vector<RobotPlan> plans;
};

TEST(MakeDependencies, OfManyTripsInOneCorridorLookAtAllPairsOfStretchesAFewTimesOnly) {
  const Neighbours fleet(300);
  support::StepLimit limit;
  const auto found = make_dependencies(fleet.robots, fleet.plans, rules(2, 0.3), support::counted(limit));
  ASSERT_TRUE(found);
  EXPECT_GT(found->list.size() + found->tight.size(), 500U);
  // 360,000 pairs, a question for each 256 of what is looked at; each stretch is in several buckets.
  EXPECT_LT(limit.steps(), 150'000);
}

TEST(MakeDependencies, EndSoonAfterTheirStop) {
  const Neighbours fleet(100);
  std::int64_t all = 0;
  {
    support::StepLimit limit;
    ASSERT_TRUE(make_dependencies(fleet.robots, fleet.plans, rules(2, 0.3), support::counted(limit)));
    all = limit.steps();
  }
  ASSERT_GT(all, 200);
  for (std::int64_t steps = 0; steps < all; steps += all / 50) {
    support::StepLimit limit(steps);
    EXPECT_FALSE(make_dependencies(fleet.robots, fleet.plans, rules(2, 0.3), support::counted(limit)));
    EXPECT_LE(limit.late(), 4) << steps;
  }
}

TEST(MakeDependencies, AreNothingIfThereAreTooMany) {
  // A robot follows another robot for weeks, at a millimetre per second.
  const std::vector<Robot> robots{robot("a", 1.0002, 0), robot("b", 0, 0)};
  const std::vector<RobotPlan> plans{PlanBuilder(0, robots[0]).translate_to(2000, 0, 1e-3).build(),
                                     PlanBuilder(1, robots[1]).wait(1.0).translate_to(1998, 0, 1e-3).build()};
  EXPECT_FALSE(made_or_none(robots, plans, 0.1));
  EXPECT_TRUE(made_or_none(robots, plans, 1000.0));
}

TEST(MakeDependencies, AreNothingWhenStopped) {
  const auto robots = crossing_robots();
  const StopCondition over(StopCondition::Clock::now());
  EXPECT_FALSE(make_dependencies(robots, crossing(robots, 4.0), rules(2), over));
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
