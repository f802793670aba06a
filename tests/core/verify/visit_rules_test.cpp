// The first and the last pose of a plan.
// Goals are visited in their order, in time and for their service.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <numbers>
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

constexpr double kForEver = std::numeric_limits<double>::infinity();

Goal goal_at(double x, double y, double service = 0.0, double not_before = 0.0) {
  return {Position(x, y), std::nullopt, service, not_before};
}

/// A robot that drives from (2, 5) by (5, 5) to (9, 5). It waits at (5, 5) from t = 3 to 5, and at (9, 5)
/// from 9 to 10. Its goals on the way are `via`.
Scene tour(std::vector<Goal> via) {
  Scene scene;
  scene.add(robot_at(2, 5),
            [](PlanBuilder& plan) { plan.translate_to(5, 5).wait(2).translate_to(9, 5).wait(1); });
  scene.robots()[0].via = std::move(via);
  return scene;
}

TEST(Visits, TakePlaceAtRest) {
  EXPECT_THAT(tour({goal_at(5, 5)}).violations(), IsEmpty());
  EXPECT_THAT(tour({goal_at(5, 5, 2.0)}).violations(), IsEmpty());
  EXPECT_THAT(tour({goal_at(5, 5, 1.5, 3.5)}).violations(), IsEmpty());
  EXPECT_THAT(tour({goal_at(2, 5), goal_at(5, 5), goal_at(9, 5)}).violations(), IsEmpty());
}

TEST(Visits, AreMissedByPassing) {
  const auto violations = tour({goal_at(4, 5)}).violations();
  ASSERT_THAT(kinds_of(violations), ElementsAre(Kind::wrong_visit));
  EXPECT_DOUBLE_EQ(violations[0].distance, 1.0);
  EXPECT_THAT(violations[0].detail, HasSubstr("goals[0] is not visited"));
}

TEST(Visits, HaveAnOrder) {
  EXPECT_THAT(kinds_of(tour({goal_at(9, 5), goal_at(5, 5)}).violations()), ElementsAre(Kind::wrong_visit));
  EXPECT_THAT(kinds_of(tour({goal_at(5, 5), goal_at(2, 5)}).violations()), ElementsAre(Kind::wrong_visit));
}

TEST(Visits, LastAsLongAsTheService) {
  const auto violations = tour({goal_at(5, 5, 2.5)}).violations();
  ASSERT_THAT(kinds_of(violations), ElementsAre(Kind::wrong_visit));
  EXPECT_DOUBLE_EQ(violations[0].distance, 5.0);
  EXPECT_DOUBLE_EQ(violations[0].required, 5.5);
  EXPECT_EQ(violations[0].detail,
            "the robot leaves goals[0] at t = 5 s, but its service there ends at t = 5.5 s");
  EXPECT_THAT(kinds_of(tour({goal_at(5, 5, 1.0, 4.5)}).violations()), ElementsAre(Kind::wrong_visit));
}

TEST(Visits, InOnePoseFollowEachOtherWithinOneRest) {
  EXPECT_THAT(tour({goal_at(5, 5, 1.0), goal_at(5, 5, 1.0)}).violations(), IsEmpty());
  EXPECT_EQ(tour({goal_at(5, 5, 1.0), goal_at(5, 5, 1.5)}).violations().size(), 1U);
}

TEST(Visits, NeedTheHeadingOfTheGoal) {
  Goal goal = goal_at(5, 5);
  goal.theta = 0.0;
  EXPECT_THAT(tour({goal}).violations(), IsEmpty());
  goal.theta = 1.0;
  const auto violations = tour({goal}).violations();
  ASSERT_THAT(kinds_of(violations), ElementsAre(Kind::wrong_visit));
  EXPECT_THAT(violations[0].detail, HasSubstr("another heading"));
}

TEST(Visits, AreInterruptedByATurn) {
  Scene scene;
  scene.add(robot_at(2, 5), [](PlanBuilder& plan) {
    plan.translate_to(5, 5).wait(1).rotate_to(3.0).rotate_to(0.0).wait(1).translate_to(9, 5);
  });
  scene.robots()[0].via = {goal_at(5, 5, 1.0)};
  EXPECT_THAT(scene.violations(), IsEmpty());
  scene.robots()[0].via = {goal_at(5, 5, 2.0)};
  EXPECT_EQ(scene.violations().size(), 1U);
}

TEST(Visits, ToTheLastGoalEndWithThePlan) {
  Scene scene = tour({});
  scene.robots()[0].goal->service = 1.0;
  EXPECT_THAT(scene.violations(), IsEmpty());
  scene.robots()[0].goal->not_before = 9.5;
  const auto violations = scene.violations();
  ASSERT_THAT(kinds_of(violations), ElementsAre(Kind::wrong_visit));
  EXPECT_DOUBLE_EQ(violations[0].distance, 10.0);
  EXPECT_DOUBLE_EQ(violations[0].required, 10.5);
}

TEST(Visits, ThatAPlanClaimsHaveToTakePlace) {
  Scene scene = tour({goal_at(5, 5, 1.0)});
  auto& visits = scene.plans()[0].visits;
  visits = {{0, 3.0, 4.0}, {1, 9.0, kForEver}};
  EXPECT_THAT(scene.violations(), IsEmpty());
  for (const std::vector<Visit>& wrong :
       std::vector<std::vector<Visit>>{{{0, 3.0, 4.0}},
                                       {{1, 3.0, 4.0}, {0, 9.0, kForEver}},
                                       {{0, 2.9, 4.0}, {1, 9.0, kForEver}},
                                       {{0, 3.0, 3.5}, {1, 9.0, kForEver}},
                                       {{0, 3.0, 5.5}, {1, 9.0, kForEver}},
                                       {{0, 3.0, 4.0}, {1, 8.0, kForEver}}}) {
    visits = wrong;
    EXPECT_THAT(kinds_of(scene.violations()), ElementsAre(Kind::wrong_visit));
  }
}

TEST(Visits, ThatAWaitNamesHaveToTakePlace) {
  Scene scene = tour({goal_at(5, 5, 1.0)});
  scene.action(1).goal = 0;
  scene.action(3).goal = 1;
  EXPECT_THAT(scene.violations(), IsEmpty());
  scene.action(1).goal = 1;
  EXPECT_THAT(kinds_of(scene.violations()), ElementsAre(Kind::wrong_visit));
  scene.action(1).goal = 7;
  EXPECT_THAT(kinds_of(scene.violations()), ElementsAre(Kind::wrong_visit));
  scene.robots()[0].committed = {scene.action(0), scene.action(1)};  // then it comes from the request
  EXPECT_THAT(scene.violations(), IsEmpty());
}

TEST(Visits, OfRobotsWithoutAPlanAreNotChecked) {
  Scene scene;
  Robot robot = robot_at(2, 5);
  robot.via = {goal_at(5, 5)};
  robot.goal = goal_at(9, 5);
  scene.stand(robot);
  EXPECT_THAT(scene.violations(), IsEmpty());
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
