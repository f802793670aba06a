// The vicinity of robots: a distance that they keep from each other, but not from walls or obstacles.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/core/verify/scene.h"

namespace fleetplan::core {
namespace TEST_FILE {

using support::PlanBuilder;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr double kPi = 3.141592653589793;

Robot with_vicinity(Robot robot, double vicinity) {
  robot.vicinity = vicinity;
  return robot;
}

/// One robot of radius 0.5 m passes another robot, which stands. Their centres come within `distance`.
Scene passing(double distance, double vicinity, double other_vicinity) {
  Scene scene;
  scene.add(with_vicinity(robot_at(2, 10), vicinity), [](PlanBuilder& plan) { plan.translate_to(18, 10); });
  scene.stand(with_vicinity(robot_at(10, 10 + distance), other_vicinity));
  return scene;
}

TEST(Vicinity, OfBothRobotsIsKept) {
  EXPECT_THAT(passing(1.51, 0.2, 0.3).violations(), IsEmpty());
  const auto violations = passing(1.49, 0.2, 0.3).violations();
  ASSERT_THAT(kinds_of(violations), ElementsAre(Kind::robot_collision));
  EXPECT_DOUBLE_EQ(violations[0].required, 1.5);
  EXPECT_NEAR(violations[0].distance, 1.49, 1e-9);
}

TEST(Vicinity, OfOneRobotIsKept) {
  EXPECT_THAT(passing(1.21, 0.2, 0.0).violations(), IsEmpty());
  EXPECT_THAT(kinds_of(passing(1.19, 0.0, 0.2).violations()), ElementsAre(Kind::robot_collision));
}

TEST(Vicinity, IsNoPartOfTheClearance) {
  EXPECT_NEAR(*passing(1.75, 0.2, 0.3).check().min_clearance, 0.75, 1e-9);
  EXPECT_NEAR(*passing(1.2, 0.2, 0.3).check().min_clearance, 0.2, 1e-9);
}

TEST(Vicinity, IsNotKeptFromWalls) {
  Scene scene;
  scene.add(with_vicinity(robot_at(2, 0.5), 3.0), [](PlanBuilder& plan) { plan.translate_to(18, 0.5); });
  EXPECT_THAT(scene.violations(), IsEmpty());
}

TEST(Vicinity, IsNotKeptFromMovingObstacles) {
  Scene scene;
  scene.stand(with_vicinity(robot_at(10, 10), 3.0)).obstacle({{0.0, {5, 11.1}}, {20.0, {15, 11.1}}});
  EXPECT_THAT(scene.violations(CheckRules()), IsEmpty());
}

TEST(Vicinity, RobotsThatBeginWithinItLeaveWithoutComingNearer) {
  Scene parting;
  parting.add(with_vicinity(robot_at(8, 10, kPi), 0.5), [](PlanBuilder& plan) { plan.translate_to(4, 10); });
  parting.stand(with_vicinity(robot_at(9.2, 10), 0.5));
  EXPECT_THAT(parting.violations(), IsEmpty());
  Scene nearing;
  nearing.add(with_vicinity(robot_at(8, 10, 0.0), 0.5),
              [](PlanBuilder& plan) { plan.translate_to(8.1, 10); });
  nearing.stand(with_vicinity(robot_at(9.2, 10), 0.5));
  EXPECT_THAT(kinds_of(nearing.violations()), ElementsAre(Kind::robot_collision));
}

TEST(Vicinity, ThatRobotsHaveLeftTheyKeep) {
  Scene scene;
  scene.add(with_vicinity(robot_at(8, 10, kPi), 0.5),
            [](PlanBuilder& plan) { plan.translate_to(4, 10).rotate_to(0.0).translate_to(8, 10); });
  scene.stand(with_vicinity(robot_at(9.2, 10), 0.5));
  EXPECT_THAT(kinds_of(scene.violations()), ElementsAre(Kind::robot_collision));
}

TEST(Vicinity, IsKeptWithTheIntervalMarginToo) {
  Scene scene;
  scene.add(with_vicinity(robot_at(2, 10), 0.2), [](PlanBuilder& plan) { plan.translate_to(18, 10); });
  // Crosses the way of the first one 2 s later, which is 2 m behind its centre.
  scene.add(with_vicinity(robot_at(10, 2, kPi / 2), 0.2),
            [](PlanBuilder& plan) { plan.wait(2.0).translate_to(10, 18); });
  CheckRules rules;
  EXPECT_THAT(scene.violations(rules), ElementsAre());
  rules.interval_margin = 0.5;
  EXPECT_THAT(kinds_of(scene.violations(rules)), ElementsAre(Kind::margin));
  for (Robot& robot : scene.robots()) robot.vicinity = 0.0;
  EXPECT_THAT(scene.violations(rules), ElementsAre());
}

TEST(Vicinity, OfCommittedMotionsIsNotKept) {
  Scene scene = passing(1.2, 0.3, 0.3);
  scene.robots()[0].committed = scene.plans()[0].actions;
  EXPECT_THAT(scene.violations(), IsEmpty());
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
