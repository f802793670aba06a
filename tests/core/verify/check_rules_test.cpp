#include "core/verify/check_rules.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "core/geometry/tolerance.h"
#include "tests/core/verify/scene.h"
#include "tests/support/plain_check.h"

namespace fleetplan::core {
namespace TEST_FILE {

using support::PlanBuilder;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

std::vector<Violation> violations(Scene& scene, const std::vector<Tolerance>& tolerances) {
  return verify(open_map(), scene.robots(), scene.plans(), tolerances, StopCondition::never())->violations;
}

TEST(PlanTolerances, AreContactAndRoundingForOrdinaryFleets) {
  const std::vector<Robot> robots{robot_at(5, 5), robot_at(8, 8)};
  const auto tolerances = plan_tolerances(open_map(), robots, {{0, 100.0, {}, 0.0}});
  for (const Tolerance& tolerance : tolerances) {
    EXPECT_GE(tolerance.metres, kContactTolerance);
    EXPECT_LE(tolerance.metres, kContactTolerance + 1e-8);
    EXPECT_LE(tolerance.seconds, 1e-8);
    EXPECT_LE(tolerance.radians, 1e-8);
  }
}

TEST(PlanTolerances, NeverExceedAMicrometreAndDependOnTheRobotAlone) {
  std::vector<Robot> robots{robot_at(5, 5), robot_at(8, 8), robot_at(2, 2)};
  robots[1].linear_speed = 1e3;
  robots[1].angular_speed = 1e6;
  robots[2].linear_speed = 10.0;
  const std::vector<RobotPlan> plans{{0, 50.0, {}, 0.0}, {1, 1e6, {}, 0.0}, {2, 1e8, {}, 0.0}};
  const auto tolerances = plan_tolerances(OccupancyGrid(1000, 1000, 1000.0), robots, plans);
  for (const Tolerance& tolerance : tolerances) {
    EXPECT_LE(tolerance.metres, kMaxTolerance);
    EXPECT_LE(tolerance.seconds, 1e-6);
    EXPECT_LE(tolerance.radians, 1e-8);
  }
  EXPECT_LE(tolerances[0].metres, kContactTolerance + 1e-8);
  EXPECT_LE(tolerances[0].seconds, 1e-8);
}

TEST(Tolerances, ApplyToTheirOwnRobotAndUnit) {
  Scene scene;
  for (const double y : {5.0, 9.0}) {
    scene.add(robot_at(5, y), [](PlanBuilder& plan) { plan.rotate_to(1.0).rotate_to(0.0); });
  }
  const std::vector<Tolerance> tolerances{{0.1, 1e-6, 1e-6}, {1e-6, 1e-6, 0.1}};
  EXPECT_THAT(violations(scene, tolerances), IsEmpty());
  for (const std::size_t robot : {0, 1}) {
    scene.action(1, robot).from.theta = 1.05;  // a jump, and more rotation than the time allows
    scene.action(1, robot).from.position.x() = 5.05;
  }
  for (const Violation& violation : violations(scene, tolerances)) {
    const std::string unit = violation.robots[0] == 0 ? "rad" : " m";
    EXPECT_NE(violation.detail.find(unit), std::string::npos) << violation.detail;
  }
  EXPECT_FALSE(violations(scene, tolerances).empty());
}

TEST(Tolerances, OfTwoRobotsAllowForTheLargerOverlap) {
  Scene scene;
  scene.stand(robot_at(5, 5)).stand(robot_at(5.95, 5)).stand(robot_at(6.9, 5));
  const Tolerance wide = Tolerance::of_all(0.1);
  const Tolerance narrow = Tolerance::of_all(1e-6);
  EXPECT_THAT(violations(scene, {narrow, wide, narrow}), IsEmpty());
  const auto found = violations(scene, {wide, narrow, narrow});
  ASSERT_EQ(found.size(), 1u);
  EXPECT_THAT(found[0].robots, ElementsAre(1, 2));
}

Violation at(double t) { return {Kind::speed, {0}, t, 0.0, 0.0, ""}; }

TEST(ViolationList, KeepsTheFirstByTimeAndCountsAll) {
  ViolationList list;
  const std::size_t count = 3 * kMaxViolations + 5;
  for (std::size_t k = 0; k < count; ++k) list.add(at(static_cast<double>(count - k)));
  EXPECT_EQ(list.total(), count);
  const auto kept = list.take();
  ASSERT_EQ(kept.size(), kMaxViolations);
  EXPECT_EQ(kept.front().t, 1.0);
  EXPECT_EQ(kept.back().t, static_cast<double>(kMaxViolations));
}

TEST(ViolationList, KeepsTheSameInWhateverOrderTheyCome) {
  std::vector<double> times;
  for (std::size_t k = 0; k < 5 * kMaxViolations; ++k) times.push_back(static_cast<double>(k / 3));
  std::mt19937 random(1);
  for (int order = 0; order < 4; ++order) {
    if (order == 1) std::reverse(times.begin(), times.end());
    if (order > 1) std::shuffle(times.begin(), times.end(), random);
    ViolationList list;
    for (const double t : times) list.add(at(t));
    EXPECT_EQ(list.total(), times.size());
    const auto kept = list.take();
    ASSERT_EQ(kept.size(), kMaxViolations);
    for (std::size_t k = 0; k < kept.size(); ++k) ASSERT_EQ(kept[k].t, static_cast<double>(k / 3));
  }
}

TEST(ViolationList, CountsThoseOfAnotherListThatItDropped) {
  ViolationList many;
  for (std::size_t k = 0; k < 2 * kMaxViolations; ++k) many.add(at(0.0));
  ViolationList all;
  all.add(at(1.0));
  all.add(std::move(many));
  EXPECT_EQ(all.total(), 2 * kMaxViolations + 1);
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
  EXPECT_EQ(report.violations.size(), kMaxViolations);
  EXPECT_GE(report.violation_count, 30'000U) << "each leap is too fast";
  EXPECT_EQ(report.violations.front().t, 0.0);
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
