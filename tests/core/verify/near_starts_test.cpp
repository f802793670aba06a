// Robots that start nearer to each other, or to a wall, than they have to keep.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/core/verify/scene.h"

namespace fleetplan::core {
namespace TEST_FILE {

using support::PlanBuilder;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr double kPi = 3.141592653589793;

CheckRules rules_of(double inflation, double start_overlap) {
  CheckRules rules;
  rules.inflation = inflation;
  rules.start_overlap = start_overlap;
  return rules;
}

/// Two robots of radius 0.5 m that start with centres `distance` apart and drive away from each other.
Scene parting(double distance) {
  Scene scene;
  scene.add(robot_at(8, 10, kPi), [](PlanBuilder& plan) { plan.translate_to(4, 10); });
  scene.add(robot_at(8 + distance, 10), [](PlanBuilder& plan) { plan.translate_to(16, 10); });
  return scene;
}

TEST(StartOverlap, IsAllowedUpToTheGivenDepth) {
  EXPECT_THAT(parting(0.9).violations(rules_of(0, 0.1)), IsEmpty());
  EXPECT_THAT(kinds_of(parting(0.9).violations(rules_of(0, 0.05))), ElementsAre(Kind::robot_collision));
  EXPECT_THAT(kinds_of(parting(0.9).violations(rules_of(0, 0))), ElementsAre(Kind::robot_collision));
}

TEST(StartOverlap, MustNotBecomeDeeper) {
  Scene scene;
  scene.add(robot_at(8, 10, kPi), [](PlanBuilder& plan) { plan.translate_to(4, 10); });
  scene.add(robot_at(8.9, 10, kPi), [](PlanBuilder& plan) { plan.translate_to(8.85, 10, 1.5); });
  scene.robots()[1].linear_speed = 2.0;
  EXPECT_EQ(scene.violations(rules_of(0, 0.5)).size(), 1U);
}

TEST(StartOverlap, EndsForGood) {
  Scene scene;
  scene.add(robot_at(8, 10, kPi),
            [](PlanBuilder& plan) { plan.translate_to(6, 10).rotate_to(0.0).translate_to(7.95, 10); });
  scene.stand(robot_at(8.9, 10));
  scene.robots()[0].angular_speed = 100.0;
  const auto violations = scene.violations(rules_of(0, 0.5));
  ASSERT_THAT(kinds_of(violations), ElementsAre(Kind::robot_collision));
  EXPECT_GT(violations[0].t, 2.0);
}

TEST(StartOverlap, OfRobotsThatStayIsAllowed) {
  Scene scene;
  scene.stand(robot_at(8, 10)).stand(robot_at(8.9, 10));
  EXPECT_THAT(scene.violations(rules_of(0, 0.2)), IsEmpty());
}

TEST(StartOverlap, OfManyRobotsThatStayHidesNoCollision) {
  Scene scene(open_map(40, 20));
  constexpr int kStacked = 300;  // all pairs are more than the checker lists
  for (int i = 0; i < kStacked; ++i) scene.stand(robot_at(2.0 + 1e-3 * i, 10));
  scene.add(robot_at(10, 10), [](PlanBuilder& plan) { plan.translate_to(20, 10); });
  scene.stand(robot_at(20.5, 10));
  const auto violations = scene.violations(rules_of(0, 1.0));
  ASSERT_THAT(kinds_of(violations), ElementsAre(Kind::robot_collision));
  EXPECT_THAT(violations[0].robots, ElementsAre(kStacked, kStacked + 1));
}

TEST(StartOverlap, WithAWallIsLeft) {
  Scene scene;
  scene.add(robot_at(0.4, 10), [](PlanBuilder& plan) { plan.translate_to(4, 10); });
  EXPECT_THAT(scene.violations(rules_of(0, 0.1)), IsEmpty());
  EXPECT_THAT(kinds_of(scene.violations(rules_of(0, 0.05))), ElementsAre(Kind::obstacle_collision));
  Scene deeper;
  deeper.add(robot_at(0.4, 10, kPi), [](PlanBuilder& plan) { plan.translate_to(0.35, 10); });
  EXPECT_THAT(kinds_of(deeper.violations(rules_of(0, 0.5))), ElementsAre(Kind::obstacle_collision));
  Scene returns;
  returns.add(robot_at(0.4, 10),
              [](PlanBuilder& plan) { plan.translate_to(2, 10).rotate_to(kPi).translate_to(0.45, 10); });
  EXPECT_EQ(returns.violations(rules_of(0, 0.5)).size(), 1U);
}

/// A robot of radius 0.5 m that drives to a wall and stays there, its centre so far from it, metres.
Scene entering(double distance) {
  Scene scene;
  scene.add(robot_at(4, 10, kPi), [&](PlanBuilder& plan) { plan.translate_to(distance, 10); });
  return scene;
}

CheckRules rules_at_goals(double inflation, double goal_overlap) {
  CheckRules rules;
  rules.inflation = inflation;
  rules.goal_overlap = goal_overlap;
  return rules;
}

TEST(GoalOverlap, IsAllowedUpToTheGivenDepth) {
  EXPECT_THAT(entering(0.4).violations(rules_at_goals(0, 0.1)), IsEmpty());
  EXPECT_THAT(kinds_of(entering(0.4).violations(rules_at_goals(0, 0.09))),
              ElementsAre(Kind::obstacle_collision));
  EXPECT_THAT(kinds_of(entering(0.4).violations(rules_of(0, 0.2))), ElementsAre(Kind::obstacle_collision));
  EXPECT_THAT(entering(0.4).violations(rules_at_goals(0.1, 0.2)), IsEmpty());
  EXPECT_EQ(entering(0.4).violations(rules_at_goals(0.1, 0.19)).size(), 1U);
}

TEST(GoalOverlap, IsThatOfTheLastGoalOnly) {
  Scene elsewhere = entering(0.4);
  elsewhere.robots()[0].goal->position = Position(3, 10);
  EXPECT_THAT(kinds_of(elsewhere.violations(rules_at_goals(0, 0.1))),
              ElementsAre(Kind::obstacle_collision, Kind::wrong_goal));
  Scene passes;
  passes.add(robot_at(4, 10, kPi),
             [](PlanBuilder& plan) { plan.translate_to(0.4, 10).rotate_to(0.0).translate_to(6, 10); });
  EXPECT_EQ(passes.violations(rules_at_goals(0, 0.1)).size(), 1U);
  Scene yields = entering(0.4);
  yields.robots()[0].let_yield();
  EXPECT_EQ(yields.violations(rules_at_goals(0, 0.1)).size(), 1U);
}

TEST(GoalOverlap, IsNowhereDeeperOnTheWayIn) {
  Scene scene;
  scene.add(robot_at(4, 10, kPi),
            [](PlanBuilder& plan) { plan.translate_to(0.35, 10).rotate_to(0.0).translate_to(0.4, 10); });
  EXPECT_EQ(scene.violations(rules_at_goals(0, 0.5)).size(), 1U);
  Scene twice;
  twice.add(robot_at(4, 10, kPi), [](PlanBuilder& plan) {
    plan.translate_to(0.45, 10).rotate_to(0.0).translate_to(2, 10).rotate_to(kPi).translate_to(0.4, 10);
  });
  EXPECT_EQ(twice.violations(rules_at_goals(0, 0.5)).size(), 1U);
}

TEST(GoalOverlap, IsLeftAgainFromTheStart) {
  Scene scene;
  scene.add(robot_at(0.4, 10),
            [](PlanBuilder& plan) { plan.translate_to(2, 10).rotate_to(kPi).translate_to(0.42, 10); });
  EXPECT_THAT(scene.violations(rules_at_goals(0, 0.1)), IsEmpty());
  EXPECT_EQ(scene.violations(rules_at_goals(0, 0.09)).size(), 1U);
}

TEST(GoalOverlap, OfACommitmentIsLeft) {
  Scene scene;
  scene.add(robot_at(4, 10, kPi),
            [](PlanBuilder& plan) { plan.translate_to(0.4, 10).rotate_to(0.0).translate_to(6, 10); });
  scene.robots()[0].committed = {scene.action(0)};
  EXPECT_THAT(scene.violations(rules_at_goals(0, 0.1)), IsEmpty());
  EXPECT_EQ(scene.violations(rules_at_goals(0, 0.09)).size(), 1U);
  scene.plans().clear();  // it stays there
  EXPECT_THAT(scene.violations(rules_at_goals(0, 0.1)), IsEmpty());
  Scene through;
  through.add(robot_at(4, 10, kPi), [](PlanBuilder& plan) {
    plan.translate_to(0.4, 10).rotate_to(0.0).translate_to(6, 10).rotate_to(kPi).translate_to(3, 10);
  });
  through.robots()[0].committed = through.plans()[0].actions;
  EXPECT_THAT(through.violations(rules_at_goals(0, 0.1)), IsEmpty());
  EXPECT_EQ(through.violations(rules_at_goals(0, 0.09)).size(), 1U);
}

TEST(StartOverlap, IsLeftAtTheEndOfAStraightMove) {
  // Past a block: near its corner, clear, and nearer again, in a straight line of two translations.
  Scene scene(support::ascii_map({"..........",  //
                                  "....#.#...",  //
                                  "..........",  //
                                  ".........."}));
  scene.add(robot_at(4.0, 1.55),
            [](PlanBuilder& plan) { plan.translate_to(5.5, 1.55).translate_to(8.5, 1.55); });
  EXPECT_THAT(scene.violations(rules_of(0, 0.06)), IsEmpty());
  Scene stops(support::ascii_map({"..........",  //
                                  "....#.#...",  //
                                  "..........",  //
                                  ".........."}));
  stops.add(robot_at(4.0, 1.55),
            [](PlanBuilder& plan) { plan.translate_to(5.5, 1.55).wait(1).translate_to(8.5, 1.55); });
  EXPECT_EQ(stops.violations(rules_of(0, 0.06)).size(), 1U);
}

TEST(Inflation, KeepsRobotsAndWallsApart) {
  Scene scene;
  scene.add(robot_at(2, 10), [](PlanBuilder& plan) { plan.translate_to(16, 10); });
  scene.stand(robot_at(8, 11.1));
  EXPECT_THAT(scene.violations(rules_of(0.05, 0)), IsEmpty());
  EXPECT_THAT(kinds_of(scene.violations(rules_of(0.06, 0))), ElementsAre(Kind::robot_collision));
  EXPECT_NEAR(*scene.check(rules_of(0.06, 0), StopCondition::never())->min_clearance, 0.1, 1e-12);
  Scene wall;
  wall.add(robot_at(2, 10, kPi), [](PlanBuilder& plan) { plan.translate_to(0.55, 10); });
  EXPECT_THAT(wall.violations(rules_of(0.05, 0)), IsEmpty());
  EXPECT_EQ(wall.violations(rules_of(0.06, 0)).size(), 1U);
}

TEST(Inflation, IsReducedForRobotsThatStartNear) {
  EXPECT_THAT(parting(1.05).violations(rules_of(0.1, 0)), IsEmpty());
  Scene scene;
  scene.add(robot_at(8, 10, kPi), [](PlanBuilder& plan) { plan.translate_to(4, 10); });
  scene.add(robot_at(9.05, 10, kPi), [](PlanBuilder& plan) { plan.wait(1).translate_to(5.1, 10); });
  const auto violations = scene.violations(rules_of(0.1, 0));
  ASSERT_THAT(kinds_of(violations), ElementsAre(Kind::robot_collision));
  EXPECT_GT(violations[0].t, 3.0);
}

TEST(Inflation, IsNotAskedOfCommittedMotions) {
  Scene scene;
  scene.add(robot_at(2, 10), [](PlanBuilder& plan) { plan.translate_to(16, 10); });
  scene.add(robot_at(2, 11.05), [](PlanBuilder& plan) { plan.translate_to(16, 11.05); });
  for (std::size_t i : {0U, 1U}) scene.robots()[i].committed = scene.plans()[i].actions;
  EXPECT_THAT(scene.violations(rules_of(0.1, 0)), IsEmpty());
}

TEST(InvalidRobots, MayOverlapWallsAndEachOther) {
  Scene scene;
  scene.stand(robot_at(0.3, 10)).stand(robot_at(0.6, 10));
  EXPECT_EQ(scene.violations(CheckRules{}).size(), 2U);
  for (Robot& robot : scene.robots()) robot.invalid = true;
  EXPECT_THAT(scene.violations(CheckRules{}), IsEmpty());
  scene.add(robot_at(4, 10, kPi), [](PlanBuilder& plan) { plan.translate_to(1.5, 10); });
  EXPECT_THAT(kinds_of(scene.violations(CheckRules{})), ElementsAre(Kind::robot_collision));
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
