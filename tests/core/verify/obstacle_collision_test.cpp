// Disks against blocked cells and the edge of the map.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/core/verify/scene.h"

namespace fleetplan::core {
namespace TEST_FILE {

using support::ascii_map;
using support::PlanBuilder;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr double kPi = std::numbers::pi;

OccupancyGrid map_with_a_block() {
  return ascii_map({
      "......",
      "......",
      "..##..",
      "......",
      "......",
  });
}

TEST(ObstacleCollision, AllowsContactWithTheEdgeOfTheMap) {
  const auto drive_along = [](double y) {
    Scene scene(open_map(10, 4));
    scene.add(robot_at(0.5, y), [y](PlanBuilder& plan) { plan.translate_to(9.5, y); });
    return scene.violations();
  };
  EXPECT_THAT(drive_along(0.5), IsEmpty());
  EXPECT_THAT(drive_along(3.5), IsEmpty());
  EXPECT_THAT(drive_along(0.5 - 0.5 * kTolerance), IsEmpty());
  const auto violations = drive_along(0.4);
  ASSERT_EQ(violations.size(), 1U);
  EXPECT_EQ(violations[0].kind, Kind::obstacle_collision);
  EXPECT_THAT(violations[0].robots, ElementsAre(0));
  EXPECT_EQ(violations[0].t, 0.0);
  EXPECT_NEAR(violations[0].distance, 0.4, 1e-12);
  EXPECT_EQ(violations[0].required, 0.5);
  EXPECT_EQ(violations[0].detail, "the disk reaches 0.1 m beyond the edge of the map at t = 0 s");
  EXPECT_EQ(drive_along(0.5 - 2.0 * kTolerance).size(), 1U);
}

TEST(ObstacleCollision, ChecksEverySideOfTheMap) {
  const double far = 9.6;
  const double near = 0.4;
  for (const auto& [x, y] : {std::pair{far, 5.0}, {near, 5.0}, {5.0, far}, {5.0, near}}) {
    Scene scene(open_map(10, 10));
    scene.add(robot_at(5, 5), [x = x, y = y](PlanBuilder& plan) { plan.drive_to(x, y); });
    const auto violations = scene.violations();
    ASSERT_EQ(violations.size(), 1U) << x << " " << y;
    EXPECT_NEAR(violations[0].distance, 0.4, 1e-12);
    EXPECT_NEAR(violations[0].t, scene.plans()[0].cost, 1e-12);
  }
}

TEST(ObstacleCollision, AllowsAPassageAsWideAsTheDisk) {
  const auto squeeze_through = [](double radius) {
    Scene scene(ascii_map({
        "..##..",
        "......",
        "..##..",
    }));
    scene.add(robot_at(0.7, 1.5, 0.0, radius), [](PlanBuilder& plan) { plan.translate_to(5.3, 1.5); });
    return scene.violations();
  };
  EXPECT_THAT(squeeze_through(0.5), IsEmpty());
  EXPECT_THAT(squeeze_through(0.5 + 0.5 * kTolerance), IsEmpty());
  EXPECT_EQ(squeeze_through(0.5 + 2.0 * kTolerance).size(), 1U);
}

TEST(ObstacleCollision, MeasuresADiagonalAtTheNearestCorner) {
  // The path x + y = s passes the corner (2, 2) of the block at (4 - s) / sqrt(2).
  const auto graze_at = [](double distance) {
    const double s = 4.0 - distance * std::sqrt(2.0);
    Scene scene(map_with_a_block());
    scene.add(robot_at(0.6, s - 0.6, -kPi / 4), [s](PlanBuilder& plan) { plan.translate_to(s - 0.6, 0.6); });
    return scene.violations();
  };
  EXPECT_THAT(graze_at(0.5), IsEmpty());
  EXPECT_THAT(graze_at(0.5 - 0.5 * kTolerance), IsEmpty());
  EXPECT_EQ(graze_at(0.5 - 2.0 * kTolerance).size(), 1U);
  const auto violations = graze_at(0.3);
  ASSERT_EQ(violations.size(), 1U);
  EXPECT_NEAR(violations[0].distance, 0.3, 1e-12);
  const double half_way = (4.0 - 0.3 * std::sqrt(2.0) - 1.2) * std::sqrt(2.0) / 2.0;
  EXPECT_NEAR(violations[0].t, half_way, 1e-12);
  EXPECT_EQ(violations[0].detail.substr(0, 42), "the disk reaches 0.2 m into a blocked cell");
}

TEST(ObstacleCollision, IsDeepestWhenTheCentreReachesTheBlock) {
  Scene scene(map_with_a_block());
  scene.add(robot_at(0.5, 2.5), [](PlanBuilder& plan) { plan.translate_to(5.5, 2.5); });
  const auto violations = scene.violations();
  ASSERT_EQ(violations.size(), 1U);
  EXPECT_NEAR(violations[0].t, 1.5, 1e-12);
  EXPECT_EQ(violations[0].distance, 0.0);
  EXPECT_EQ(violations[0].detail, "the centre of the disk reaches a blocked cell at t = 1.5 s");
}

TEST(ObstacleCollision, IsExactForADiskMuchLargerThanTheCells) {
  const auto pass = [](double y) {
    Scene scene(ascii_map(
        {
            "..............................",
            "..............................",
            "..............................",
            "..............................",
            "..............................",
            "..............................",
            "..............................",
            "..............................",
            "..............................",
            "..............................",
            "..............#...............",
        },
        0.1));
    scene.add(robot_at(0.5, y, 0.0, 0.45), [y](PlanBuilder& plan) { plan.translate_to(2.5, y); });
    return scene.violations();
  };
  EXPECT_THAT(pass(0.55), IsEmpty());
  const auto violations = pass(0.5);
  ASSERT_EQ(violations.size(), 1U);
  EXPECT_NEAR(violations[0].distance, 0.4, 1e-12);
  // Above the left corner of the cell, the first of the times at which the robot is nearest.
  EXPECT_NEAR(violations[0].t, 0.9, 1e-12);
}

TEST(ObstacleCollision, ReportsStandingInAnObstacleOnce) {
  Scene scene(map_with_a_block());
  scene.stand(robot_at(1.7, 2.5));
  scene.add(robot_at(1.7, 4.6), [](PlanBuilder& plan) { plan.wait(1).rotate_to(1).wait(1).rotate_to(0); });
  const auto violations = scene.violations();
  ASSERT_EQ(violations.size(), 2U);
  EXPECT_THAT(violations[0].robots, ElementsAre(0));
  EXPECT_EQ(violations[0].t, 0.0);
  EXPECT_NEAR(violations[0].distance, 0.3, 1e-12);
  EXPECT_THAT(violations[1].robots, ElementsAre(1));
}

TEST(ObstacleCollision, MergesActionsOfOneOverlapOnly) {
  Scene scene(map_with_a_block());
  scene.add(robot_at(0.5, 2.5), [](PlanBuilder& plan) {
    plan.translate_to(1.6, 2.5).wait(2).translate_to(1.8, 2.5).wait(1);  // in, and deeper
    plan.translate_to(0.5, 2.5).wait(1);                                 // out again
    plan.translate_to(1.7, 2.5).translate_to(0.5, 2.5);                  // and in, and out
  });
  const auto violations = scene.violations();
  ASSERT_EQ(violations.size(), 2U);
  EXPECT_NEAR(violations[0].distance, 0.2, 1e-12);
  EXPECT_NEAR(violations[0].t, 3.3, 1e-12);
  EXPECT_NEAR(violations[1].distance, 0.3, 1e-12);
}

TEST(ObstacleCollision, ReportsAPassThroughAnObstacleAndBackAsTwo) {
  Scene scene(map_with_a_block());
  scene.add(robot_at(0.5, 2.5),
            [](PlanBuilder& plan) { plan.translate_to(5.5, 2.5).translate_to(0.5, 2.5); });
  const auto violations = scene.violations();
  ASSERT_EQ(violations.size(), 2U);
  EXPECT_NEAR(violations[0].t, 1.5, 1e-12);
  EXPECT_NEAR(violations[1].t, 6.5, 1e-12);
}

TEST(ObstacleCollision, ReportsOverlapsBeforeAndAfterAJumpSeparately) {
  Scene scene(map_with_a_block());
  scene.add(robot_at(1.7, 2.5), [](PlanBuilder& plan) { plan.wait(1).wait(1).wait(1); });
  EXPECT_EQ(scene.violations().size(), 1U);
  const auto jump_to = [&scene](const Position& there) {
    scene.action(1).from.position = scene.action(1).to.position = there;
    std::vector<double> times;
    for (const Violation& violation : scene.violations()) {
      if (violation.kind == Kind::obstacle_collision) times.push_back(violation.t);
    }
    return times;
  };
  EXPECT_THAT(jump_to(Position(4.3, 2.5)), ElementsAre(0.0, 1.0, 2.0));
  EXPECT_THAT(jump_to(Position(1.0, 1.0)), ElementsAre(0.0, 2.0));
}

TEST(ObstacleCollision, IgnoresRoundingAlongAWall) {
  Scene scene(map_with_a_block());
  const double lower = std::nextafter(std::nextafter(1.6, 1.0), 1.0);
  scene.add(robot_at(2.2, 1.6), [lower](PlanBuilder& plan) { plan.translate_to(3.7, lower); });
  const auto violations = scene.violations();
  ASSERT_EQ(violations.size(), 1U);
  EXPECT_EQ(violations[0].t, 0.0);
  Scene back(map_with_a_block());
  back.add(robot_at(2.2, lower), [](PlanBuilder& plan) { plan.translate_to(3.7, 1.6); });
  ASSERT_EQ(back.violations().size(), 1U);
  EXPECT_EQ(back.violations()[0].t, 0.0);
}

TEST(ObstacleCollision, ReportsARobotThatLeavesTheMapAtTheEdge) {
  Scene scene(map_with_a_block());
  scene.add(robot_at(1, 1),
            [](PlanBuilder& plan) { plan.translate_to(1e9, 1).rotate_to(kPi).translate_to(1, 1); });
  const auto violations = scene.violations();
  ASSERT_EQ(violations.size(), 1U);
  EXPECT_NEAR(violations[0].t, 5.0, 1e-6);
  EXPECT_EQ(violations[0].distance, 0.0);
}

TEST(ObstacleCollision, ReportsRobotsOutsideTheMap) {
  Scene scene(map_with_a_block());
  scene.stand(robot_at(-100, 2)).stand(robot_at(3, 1e12)).stand(robot_at(0, 0));
  EXPECT_THAT(kinds_of(scene.violations()),
              ElementsAre(Kind::obstacle_collision, Kind::obstacle_collision, Kind::obstacle_collision));
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
