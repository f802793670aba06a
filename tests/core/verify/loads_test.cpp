// Goals after which a robot has another radius.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>
#include <optional>

#include "tests/core/verify/scene.h"

namespace fleetplan::core {
namespace TEST_FILE {

using support::PlanBuilder;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

Goal load(double x, double y, double service, double radius_after) {
  return {Position(x, y), std::nullopt, service, 0.0, radius_after};
}

/// A robot of radius 0.5 m drives from (2, 10) to (8, 10). There, it has `radius_after` from t = 8 on. Then
/// it drives to (18, 10), where it arrives at t = 18.
Scene carrying(double radius_after) {
  Scene scene;
  Robot robot = robot_at(2, 10);
  robot.via = {load(8, 10, 2.0, radius_after)};
  scene.add(robot, [](PlanBuilder& plan) { plan.translate_to(8, 10).wait(2).translate_to(18, 10); });
  return scene;
}

TEST(LoadRules, ALoadNeedsItsOwnRoomFromTheServiceOn) {
  Scene before = carrying(1.0);
  before.stand(robot_at(5, 11.2));
  EXPECT_THAT(before.violations(), IsEmpty()) << "there is room for the robot alone";
  Scene after = carrying(1.0);
  after.stand(robot_at(13, 11.2));
  const auto violations = after.violations();
  ASSERT_THAT(kinds_of(violations), ElementsAre(Kind::robot_collision));
  EXPECT_THAT(violations[0].robots, ElementsAre(0, 1));
  EXPECT_DOUBLE_EQ(violations[0].required, 1.5);
  EXPECT_NEAR(violations[0].t, 13.0, 1e-9);
}

TEST(LoadRules, APlanThatIsValidWithoutTheLoadIsNotValidWithIt) {
  Scene scene = carrying(1.0);
  scene.stand(robot_at(13, 11.2));
  EXPECT_THAT(kinds_of(scene.violations()), ElementsAre(Kind::robot_collision));
  scene.robots()[0].via[0].radius_after.reset();
  EXPECT_THAT(scene.violations(), IsEmpty());
}

TEST(LoadRules, ARobotThatHasPutItsLoadDownNeedsLess) {
  Scene scene = carrying(0.2);
  scene.stand(robot_at(13, 10.8));
  EXPECT_THAT(scene.violations(), IsEmpty());
  EXPECT_NEAR(*scene.check().min_clearance, 0.1, 1e-9);
  Scene early = carrying(0.2);
  early.stand(robot_at(5, 10.8));
  EXPECT_THAT(kinds_of(early.violations()), ElementsAre(Kind::robot_collision));
}

TEST(LoadRules, ALoadedRobotIsNoFasterThanItsLoadAllows) {
  Scene scene = carrying(0.5);
  scene.robots()[0].via[0].linear_speed_after = 2.0;
  EXPECT_THAT(scene.violations(), IsEmpty()) << "it may be faster, and is not";
  scene.robots()[0].via[0].linear_speed_after = 0.9;
  const auto violations = scene.violations();
  ASSERT_THAT(kinds_of(violations), ElementsAre(Kind::speed));
  EXPECT_NEAR(violations[0].t, 8.0, 1e-9) << "before the service it was as fast as it may be";
  EXPECT_DOUBLE_EQ(violations[0].required, 0.9);
}

TEST(LoadRules, ALoadHasToFitBetweenWalls) {
  Scene scene;
  Robot robot = robot_at(2, 0.6);
  robot.via = {load(8, 0.6, 2.0, 0.7)};
  scene.add(robot, [](PlanBuilder& plan) { plan.translate_to(8, 0.6).wait(2).translate_to(18, 0.6); });
  const auto violations = scene.violations();
  ASSERT_THAT(kinds_of(violations), ElementsAre(Kind::obstacle_collision));
  EXPECT_DOUBLE_EQ(violations[0].t, 8.0);
  EXPECT_DOUBLE_EQ(violations[0].required, 0.7);
}

TEST(LoadRules, TheLastGoalChangesTheRadiusForGood) {
  Scene scene;
  Robot robot = robot_at(2, 10);
  scene.add(robot, [](PlanBuilder& plan) { plan.translate_to(8, 10).wait(2); });
  scene.robots()[0].goal = load(8, 10, 2.0, 1.0);
  EXPECT_THAT(scene.violations(), IsEmpty());
  scene.stand(robot_at(8, 11.2));
  const auto violations = scene.violations();
  ASSERT_THAT(kinds_of(violations), ElementsAre(Kind::robot_collision));
  EXPECT_DOUBLE_EQ(violations[0].t_begin.value_or(0.0), 8.0);
}

TEST(LoadRules, ALoadPickedUpWhereACommitmentEndsMayBeWithinTheInflation) {
  const auto kinds_beside = [](double y) {
    Scene scene;
    Robot robot = robot_at(2, 10);
    robot.via = {load(8, 10, 0.0, 1.0)};
    robot.goal = Goal{Position(18, 10), std::nullopt};
    robot.committed = PlanBuilder(0, robot).translate_to(8, 10).build().actions;
    Robot other = robot_at(8, y);
    other.goal = Goal{Position(8, 18), std::nullopt};
    scene.stand(robot).stand(other);
    CheckRules rules;
    rules.inflation = 0.1;
    return kinds_of(scene.violations(rules));
  };
  EXPECT_THAT(kinds_beside(11.6), IsEmpty());
  EXPECT_THAT(kinds_beside(11.4), ElementsAre(Kind::robot_collision)) << "the disks overlap";
}

TEST(LoadRules, ARobotAloneHasNoClearance) {
  EXPECT_EQ(carrying(1.0).check().min_clearance, std::nullopt) << "its own disks are no pair";
}

TEST(LoadRules, TheMarginIsThatOfTheRadiusAtEachTime) {
  const auto kinds_with = [](double radius_after) {
    Scene scene = carrying(radius_after);
    // Comes to the way of the robot 3.7 s after that has passed.
    scene.add(robot_at(13, 14, -std::numbers::pi / 2.0),
              [](PlanBuilder& plan) { plan.wait(14.0).translate_to(13, 11.3); });
    CheckRules rules;
    rules.interval_margin = 5.0;
    return kinds_of(scene.violations(rules));
  };
  EXPECT_THAT(kinds_with(0.5), IsEmpty());
  EXPECT_THAT(kinds_with(1.0), ElementsAre(Kind::margin));
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
