// The first and the last pose of a plan.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

#include "tests/core/verify/scene.h"

namespace fleetplan::core {
namespace TEST_FILE {

using support::PlanBuilder;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

Scene driving() {
  Scene scene;
  scene.add(robot_at(5, 5), [](PlanBuilder& plan) { plan.translate_to(8, 5).rotate_to(1); });
  return scene;
}

TEST(WrongStart, IsReportedWhereAPlanDoesNotBeginAtTheStart) {
  Scene scene = driving();
  EXPECT_THAT(scene.violations(), IsEmpty());
  scene.robots()[0].start.position.x() += 0.5 * kTolerance;
  EXPECT_THAT(scene.violations(), IsEmpty());
  scene.robots()[0].start.position.x() = 4.0;
  const auto violations = scene.violations();
  ASSERT_THAT(kinds_of(violations), ElementsAre(Kind::wrong_start));
  EXPECT_EQ(violations[0].t, 0.0);
  EXPECT_NEAR(violations[0].distance, 1.0, 1e-12);
  EXPECT_EQ(violations[0].detail, "the plan starts 1 m from the robot's start");
}

TEST(WrongStart, IsReportedForTheHeadingAsWell) {
  Scene scene = driving();
  scene.robots()[0].start.theta = 0.5;
  const auto violations = scene.violations();
  ASSERT_THAT(kinds_of(violations), ElementsAre(Kind::wrong_start));
  EXPECT_NEAR(violations[0].distance, 0.5, 1e-12);
  EXPECT_THAT(violations[0].detail, HasSubstr("heading 0.5 rad"));
}

TEST(WrongGoal, IsReportedWhereAPlanDoesNotEndAtTheGoal) {
  Scene scene = driving();
  scene.robots()[0].goal->position.y() = 6.0;
  const auto violations = scene.violations();
  ASSERT_THAT(kinds_of(violations), ElementsAre(Kind::wrong_goal));
  EXPECT_EQ(violations[0].t, 4.0);
  EXPECT_NEAR(violations[0].distance, 1.0, 1e-12);
  EXPECT_EQ(violations[0].detail, "the plan ends 1 m from the robot's goal");
}

TEST(WrongGoal, IsReportedForTheHeadingIfTheGoalHasOne) {
  Scene scene = driving();
  scene.robots()[0].goal->theta = 1.5;
  const auto violations = scene.violations();
  ASSERT_THAT(kinds_of(violations), ElementsAre(Kind::wrong_goal));
  EXPECT_NEAR(violations[0].distance, 0.5, 1e-12);
  scene.robots()[0].goal->theta.reset();
  EXPECT_THAT(scene.violations(), IsEmpty());
}

TEST(WrongGoal, AllowsAParkedRobotAnyHeadingAtItsStart) {
  Scene scene = driving();
  scene.robots()[0].goal.reset();
  const auto violations = scene.violations();
  ASSERT_THAT(kinds_of(violations), ElementsAre(Kind::wrong_goal));
  EXPECT_NEAR(violations[0].distance, 3.0, 1e-12);

  Scene aside;
  aside.add(robot_at(5, 5),
            [](PlanBuilder& plan) { plan.translate_to(7, 5).translate_to(5, 5).rotate_to(1); });
  aside.robots()[0].goal.reset();
  EXPECT_THAT(aside.violations(), IsEmpty());
}

TEST(WrongGoal, AllowsAnEmptyPlanOnlyAtTheGoal) {
  Scene scene;
  scene.add(robot_at(5, 5), [](PlanBuilder&) {});
  EXPECT_THAT(scene.violations(), IsEmpty());
  scene.robots()[0].goal = Goal{Position(5, 5), 0.0};
  EXPECT_THAT(scene.violations(), IsEmpty());
  scene.robots()[0].goal = Goal{Position(5, 7), 0.0};
  EXPECT_THAT(kinds_of(scene.violations()), ElementsAre(Kind::wrong_goal));
}

TEST(WrongGoal, AllowsARobotWithoutAPlan) {
  Scene scene;
  Robot robot = robot_at(5, 5);
  robot.goal = Goal{Position(8, 5), 0.0};
  scene.stand(robot);
  EXPECT_THAT(scene.violations(), IsEmpty());
}

TEST(Verify, ReportsViolationsInOrderOfTime) {
  Scene scene = driving();
  scene.robots()[0].goal->position.y() = 6.0;  // at 4 s
  scene.stand(robot_at(6, 5.5));               // hit after 1 s
  scene.robots()[0].start.theta = 0.5;
  EXPECT_THAT(kinds_of(scene.violations()),
              ElementsAre(Kind::wrong_start, Kind::robot_collision, Kind::wrong_goal));
}

TEST(Verify, AcceptsPlansInAnyOrderButNotTwice) {
  Scene scene = driving();
  scene.add(robot_at(5, 8), [](PlanBuilder& plan) { plan.translate_to(9, 8); });
  std::swap(scene.plans()[0], scene.plans()[1]);
  EXPECT_THAT(scene.violations(), IsEmpty());
  scene.plans()[0].robot = 0;
  EXPECT_THROW(scene.check(), std::invalid_argument);
  scene.plans()[0].robot = 2;
  EXPECT_THROW(scene.check(), std::invalid_argument);
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
