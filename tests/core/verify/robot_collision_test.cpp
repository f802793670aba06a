// Collisions between robots in different encounters, and the limit between contact and collision.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/core/verify/scene.h"

namespace fleetplan::core {
namespace TEST_FILE {

using support::PlanBuilder;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr double kPi = std::numbers::pi;

/// One robot passes another, which stands `gap` metres (negative: overlap) beside its path.
Scene passing_at(double gap) {
  Scene scene;
  scene.add(robot_at(2, 5), [](PlanBuilder& plan) { plan.translate_to(8, 5); });
  scene.stand(robot_at(5, 6 + gap));
  return scene;
}

TEST(RobotCollision, AllowsContactAndOverlapsWithinTheTolerance) {
  EXPECT_THAT(passing_at(0.0).violations(), IsEmpty());
  EXPECT_THAT(passing_at(0.0).violations(0.0), IsEmpty());
  EXPECT_THAT(passing_at(-0.5 * kTolerance).violations(), IsEmpty());
  EXPECT_EQ(passing_at(-2.0 * kTolerance).violations().size(), 1U);
  EXPECT_THAT(passing_at(0.1).violations(), IsEmpty());
}

TEST(RobotCollision, ReportsTimeAndDepthOfTheOverlap) {
  const auto violations = passing_at(-0.2).violations();
  ASSERT_EQ(violations.size(), 1U);
  EXPECT_EQ(violations[0].kind, Kind::robot_collision);
  EXPECT_THAT(violations[0].robots, ElementsAre(0, 1));
  EXPECT_NEAR(violations[0].t, 3.0, 1e-12);
  EXPECT_NEAR(violations[0].distance, 0.8, 1e-12);
  EXPECT_DOUBLE_EQ(violations[0].required, 1.0);
  // sqrt(1 - 0.8^2) = 0.6 m before and after.
  EXPECT_EQ(violations[0].detail, "the disks overlap by 0.2 m from t = 2.4 s to 3.6 s");
}

TEST(RobotCollision, ReportsTheTimeOfAHeadOnCollision) {
  Scene scene;
  scene.add(robot_at(2, 5, 0.0), [](PlanBuilder& plan) { plan.translate_to(8, 5); });
  scene.add(robot_at(8, 5, kPi), [](PlanBuilder& plan) { plan.translate_to(2, 5); });
  const auto violations = scene.violations();
  ASSERT_EQ(violations.size(), 1U);
  EXPECT_NEAR(violations[0].t, 3.0, 1e-12);
  EXPECT_NEAR(violations[0].distance, 0.0, 1e-12);
}

TEST(RobotCollision, AllowsAHeadOnApproachToContact) {
  Scene scene;
  scene.add(robot_at(2, 5, 0.0), [](PlanBuilder& plan) { plan.translate_to(4.5, 5); });
  scene.add(robot_at(8, 5, kPi), [](PlanBuilder& plan) { plan.translate_to(5.5, 5); });
  const auto report = scene.check();
  EXPECT_TRUE(report.valid());
  EXPECT_NEAR(*report.min_clearance, 0.0, 1e-12);
}

TEST(RobotCollision, MeasuresTheGapOfRobotsAtTheSameSpeed) {
  const auto follow = [](double gap) {
    Scene scene;
    scene.add(robot_at(3 - gap, 5), [](PlanBuilder& plan) { plan.translate_to(10, 5); });
    scene.add(robot_at(4, 5), [gap](PlanBuilder& plan) { plan.translate_to(11 + gap, 5); });
    return scene.violations();
  };
  EXPECT_THAT(follow(0.0), IsEmpty());
  EXPECT_THAT(follow(0.1), IsEmpty());
  const auto violations = follow(-0.1);
  ASSERT_EQ(violations.size(), 1U);
  EXPECT_EQ(violations[0].t, 0.0);
  EXPECT_THAT(violations[0].detail, HasSubstr("from t = 0 s on, for ever"));
}

TEST(RobotCollision, AllowsOvertakingOnlyBesideTheOther) {
  const auto overtake_at = [](double y) {
    Scene scene;
    scene.add(robot_at(4, 5), [](PlanBuilder& plan) { plan.translate_to(8, 5, 0.25); });
    scene.add(robot_at(2, y), [](PlanBuilder& plan) { plan.translate_to(14, plan.build().cost + 5, 1.0); });
    scene.action(0, 1).to.position.y() = y;
    scene.robots()[1].goal->position.y() = y;
    scene.action(0, 1).t_end = 12.0;
    scene.plans()[1].cost = 12.0;
    return scene.violations();
  };
  EXPECT_THAT(overtake_at(6.0), IsEmpty());
  const auto violations = overtake_at(5.0);
  ASSERT_EQ(violations.size(), 1U);
  EXPECT_NEAR(violations[0].t, 2.0 / 0.75, 1e-12);
}

TEST(RobotCollision, AllowsCrossingAfterASufficientWait) {
  const auto cross_after = [](double wait) {
    Scene scene;
    scene.add(robot_at(2, 5, 0.0), [](PlanBuilder& plan) { plan.translate_to(8, 5); });
    scene.add(robot_at(5, 2, kPi / 2), [wait](PlanBuilder& plan) { plan.wait(wait).translate_to(5, 8); });
    return scene.violations();
  };
  // They pass the crossing `wait` seconds apart, so their least distance is wait / sqrt(2) metres.
  EXPECT_THAT(cross_after(std::sqrt(2.0) + 1e-9), IsEmpty());
  const auto violations = cross_after(1.0);
  ASSERT_EQ(violations.size(), 1U);
  EXPECT_NEAR(violations[0].distance, 1.0 / std::sqrt(2.0), 1e-12);
  EXPECT_NEAR(violations[0].t, 3.5, 1e-12);
}

TEST(RobotCollision, ReportsAnOverlapWithoutEnd) {
  Scene scene;
  scene.add(robot_at(5, 8, -kPi / 2), [](PlanBuilder& plan) { plan.translate_to(5, 5); });
  scene.add(robot_at(10, 5, kPi), [](PlanBuilder& plan) { plan.wait(4).translate_to(5.5, 5); });
  const auto violations = scene.violations();
  ASSERT_EQ(violations.size(), 1U);
  EXPECT_NEAR(violations[0].t, 8.5, 1e-12);
  EXPECT_NEAR(violations[0].distance, 0.5, 1e-12);
  EXPECT_EQ(violations[0].detail, "the disks overlap by 0.5 m from t = 8 s on, for ever");
}

TEST(RobotCollision, AllowsContactWithAParkedRobot) {
  const auto arrive_at = [](double x) {
    Scene scene;
    scene.stand(robot_at(8, 5));
    scene.add(robot_at(2, 5), [x](PlanBuilder& plan) { plan.translate_to(x, 5); });
    return scene.violations();
  };
  EXPECT_THAT(arrive_at(7.0), IsEmpty());
  EXPECT_EQ(arrive_at(7.1).size(), 1U);
}

TEST(RobotCollision, ReportsOverlappingStartsAtTimeZero) {
  Scene scene;
  scene.stand(robot_at(5, 5)).stand(robot_at(5.5, 5)).stand(robot_at(5, 6));
  const auto violations = scene.violations();
  ASSERT_EQ(violations.size(), 1U);
  EXPECT_EQ(violations[0].t, 0.0);
  EXPECT_THAT(violations[0].robots, ElementsAre(0, 1));
}

TEST(RobotCollision, ReportsEachUninterruptedOverlapOnce) {
  Scene scene;
  scene.stand(robot_at(5, 5));
  scene.add(robot_at(2, 5), [](PlanBuilder& plan) {
    plan.translate_to(4.5, 5).wait(1).rotate_to(0.5).rotate_to(0).translate_to(8, 5).wait(2).translate_to(4.8,
                                                                                                          5);
    plan.translate_to(2, 5);
  });
  const auto violations = scene.violations();
  ASSERT_EQ(violations.size(), 2U);
  // At the same position after 2.5 m, a wait of 1 s, rotations of 1 s in total and 0.5 m.
  EXPECT_NEAR(violations[0].t, 5.0, 1e-12);
  EXPECT_NEAR(violations[0].distance, 0.0, 1e-12);
  EXPECT_NEAR(violations[1].distance, 0.0, 1e-12);
}

TEST(RobotCollision, AddsDifferentRadii) {
  Scene scene;
  scene.stand(robot_at(5, 5, 0.0, 1.5));
  scene.stand(robot_at(7, 5, 0.0, 0.5));
  EXPECT_THAT(scene.violations(), IsEmpty());
  scene.robots()[1].radius = 0.6;
  const auto violations = scene.violations();
  ASSERT_EQ(violations.size(), 1U);
  EXPECT_DOUBLE_EQ(violations[0].required, 2.1);
}

TEST(RobotCollision, LimitsTheNumberOfReportedOverlaps) {
  Scene scene;
  for (int k = 0; k < 200; ++k) scene.stand(robot_at(5, 5));
  EXPECT_EQ(scene.violations().size(), kMaxCollisions);
}

TEST(MinClearance, IsBetweenDisksWithoutInflationAndIncludesStandingRobots) {
  Scene scene;
  scene.stand(robot_at(5, 5));
  EXPECT_FALSE(scene.check().min_clearance.has_value());
  scene.stand(robot_at(5, 8));
  EXPECT_NEAR(*scene.check().min_clearance, 2.0, 1e-12);
  scene.add(robot_at(2, 6.25), [](PlanBuilder& plan) { plan.translate_to(9, 6.25); });
  EXPECT_NEAR(*scene.check().min_clearance, 0.25, 1e-12);
}

TEST(MinClearance, IsNegativeWhereDisksOverlap) {
  EXPECT_NEAR(*passing_at(-0.25).check().min_clearance, -0.25, 1e-12);
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
