// Robots against moving obstacles: when they are there, and where.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "core/model/plan.h"
#include "core/verify/execution.h"
#include "core/verify/pairs/sweeps.h"
#include "tests/core/verify/random_fleet.h"
#include "tests/core/verify/scene.h"

namespace fleetplan::core {
namespace TEST_FILE {

using support::PlanBuilder;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using After = MovingObstacle::After;
using Entry = MovingObstacle::Entry;

/// A robot that drives from (2, 5) to (8, 5) from t = 0 to 6.
Scene driving() {
  Scene scene;
  scene.add(robot_at(2, 5), [](PlanBuilder& plan) { plan.translate_to(8, 5); });
  return scene;
}

Entry at(double t, double x, double y) { return {t, Position(x, y)}; }

TEST(MovingObstacle, IsReportedWithTimeDepthAndIndex) {
  Scene scene = driving();
  scene.obstacle({at(0, 15, 15)});
  scene.obstacle({at(0, 5, 5.8), at(10, 5, 5.8)});
  const auto violations = scene.violations(CheckRules{});
  ASSERT_EQ(violations.size(), 1U);
  EXPECT_EQ(violations[0].kind, Kind::moving_obstacle);
  EXPECT_THAT(violations[0].robots, ElementsAre(0));
  EXPECT_EQ(violations[0].obstacle, 1U);
  EXPECT_NEAR(violations[0].t, 3.0, 1e-12);
  EXPECT_NEAR(violations[0].distance, 0.8, 1e-12);
  EXPECT_DOUBLE_EQ(violations[0].required, 1.0);
  EXPECT_EQ(violations[0].detail, "the disk overlaps the moving obstacle by 0.2 m from t = 2.4 s to 3.6 s");
}

TEST(MovingObstacle, MayTouchTheRobot) {
  EXPECT_THAT(driving().obstacle({at(0, 5, 6), at(10, 5, 6)}).violations(CheckRules{}), IsEmpty());
  EXPECT_THAT(driving().obstacle({at(0, 2, 6), at(6, 8, 6)}).violations(CheckRules{}), IsEmpty());
}

TEST(MovingObstacle, IsAbsentBeforeItAppearsAndAfterItLeaves) {
  EXPECT_THAT(driving().obstacle({at(4.5, 5, 5), at(9, 5, 5)}).violations(CheckRules{}), IsEmpty());
  EXPECT_THAT(driving().obstacle({at(0, 5, 5), at(1.5, 5, 5)}).violations(CheckRules{}), IsEmpty());
  EXPECT_EQ(driving().obstacle({at(0, 8, 5), at(1, 8, 5)}, After::stays).violations(CheckRules{}).size(), 1U);
  EXPECT_THAT(driving().obstacle({at(0, 8, 5), at(1, 8, 5)}).violations(CheckRules{}), IsEmpty());
}

TEST(MovingObstacle, OccupiesTheInstantAtWhichItAppearsAndVanishes) {
  EXPECT_THAT(kinds_of(driving().obstacle({at(3, 5, 5)}).violations(CheckRules{})),
              ElementsAre(Kind::moving_obstacle));
  EXPECT_THAT(driving().obstacle({at(3, 7, 5)}).violations(CheckRules{}), IsEmpty());
  // It vanishes at the moment of contact, or slightly later.
  EXPECT_THAT(driving().obstacle({at(0, 5, 5), at(2, 5, 5)}).violations(CheckRules{}), IsEmpty());
  EXPECT_EQ(driving().obstacle({at(0, 5, 5), at(2.01, 5, 5)}).violations(CheckRules{}).size(), 1U);
}

TEST(MovingObstacle, MayMeetARobotThatCannotAvoidIt) {
  Scene scene;
  scene.stand(robot_at(5, 5));
  scene.obstacle({at(0, 0, 5), at(10, 10, 5), at(20, 0, 5)});
  ASSERT_EQ(scene.violations(CheckRules{}).size(), 2U);
  CheckRules rules;
  rules.exempt = {UnavoidableCollision{0, {}, 0, 4.0}};  // of the way there
  EXPECT_EQ(scene.violations(rules).size(), 1U);
  EXPECT_GT(scene.violations(rules).front().t, 10.0);
  rules.exempt.push_back({0, {}, 0, 14.0});
  EXPECT_THAT(scene.violations(rules), IsEmpty());
  rules.exempt = {UnavoidableCollision{0, {}, 0, 2.0}};  // they do not meet then
  EXPECT_EQ(scene.violations(rules).size(), 2U);
}

TEST(MovingObstacle, MayNotMeetARobotThatThePlanMoves) {
  // However many collisions are claimed.
  Scene scene;
  scene.add(robot_at(5, 5), [](PlanBuilder& plan) { plan.wait(1); });
  scene.obstacle({at(0, 0, 5), at(10, 10, 5), at(20, 0, 5)});
  CheckRules rules;
  rules.exempt.assign(kMaxUnavoidableOfRobot, UnavoidableCollision{0, {}, 0, 4.0});
  EXPECT_EQ(scene.violations(rules).size(), 2U);
}

TEST(MovingObstacle, MayMeetARobotThatHasTooManyCollisionsToListAgain) {
  Scene scene;
  scene.stand(robot_at(5, 5));
  std::vector<MovingObstacle::Entry> motion;
  for (int k = 0; k < 30; ++k) motion.push_back(at(10 * k, k % 2 == 0 ? 0 : 10, 5));
  scene.obstacle(motion);
  CheckRules rules;
  for (std::size_t k = 0; k < kMaxUnavoidableOfRobot; ++k) {
    EXPECT_FALSE(scene.violations(rules).empty());
    rules.exempt.push_back({0, {}, 0, 10.0 * static_cast<double>(k) + 4.0});
  }
  EXPECT_THAT(scene.violations(rules), IsEmpty());
}

TEST(MovingObstacle, IsCheckedAgainstRobotsWithoutAPlan) {
  Scene scene;
  Robot robot = robot_at(2, 5);
  robot.committed = PlanBuilder(0, robot).translate_to(8, 5).build().actions;
  scene.stand(robot);
  scene.obstacle({at(0, 5, 5), at(1, 5, 5)});
  EXPECT_THAT(scene.violations(CheckRules{}), IsEmpty());
  scene.obstacle({at(0, 5, 5), at(3, 5, 5)});
  EXPECT_EQ(scene.violations(CheckRules{}).size(), 1U);
}

TEST(MovingObstacle, CheckEndsWhenItIsStopped) {
  Scene scene = driving();
  scene.obstacle({at(0, 5, 5), at(3, 5, 5)});
  const StopCondition met{StopCondition::Clock::time_point::min()};
  EXPECT_FALSE(scene.check(CheckRules{}, met));
}

class RandomObstacles : public testing::TestWithParam<int> {};

TEST_P(RandomObstacles, AreMetWhereSamplesMeetThem) {
  SCOPED_TRACE(testing::Message() << "seed " << GetParam());
  std::mt19937 random(static_cast<unsigned>(GetParam()));
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<>(low, high)(random);
  };
  const RandomFleet fleet = random_fleet(random, 5, 12.0, 6);
  ExecutedFleet executed;
  for (std::size_t i = 0; i < fleet.robots.size(); ++i) {
    const auto plan =
        std::find_if(fleet.plans.begin(), fleet.plans.end(), [i](const auto& p) { return p.robot == i; });
    executed.robots.push_back(i);
    executed.radii.push_back(fleet.robots[i].radius);
    executed.vicinities.push_back(0.0);
    executed.tolerances.push_back(0.0);
    const RobotPlan* executes = plan == fleet.plans.end() ? nullptr : &*plan;
    executed.legs.push_back(execute(fleet.robots[i], executes));
    executed.handovers.push_back(handover_of(fleet.robots[i], executes));
    executed.stays.push_back(executes == nullptr);
  }
  std::vector<std::vector<Leg>> obstacles;
  std::vector<double> radii;
  for (int k = 0; k < 4; ++k) {
    MovingObstacle obstacle{"", uniform(0.1, 0.8), {}, uniform(0, 1) < 0.5 ? After::leaves : After::stays};
    for (double t = uniform(0, 5); t < 25.0; t += uniform(0.1, 6)) {
      obstacle.motion.push_back(at(t, uniform(0, 12), uniform(0, 12)));
    }
    obstacles.push_back(legs_of(obstacle));
    radii.push_back(obstacle.radius);
  }
  const Exemptions none({}, executed, 0.0, obstacles, radii, StopCondition::never());
  const auto overlaps =
      *overlaps_with_obstacles(executed, obstacles, radii, none, 10'000, StopCondition::never());

  const auto overlap_at = [&](std::size_t robot, std::size_t obstacle, double t) {
    return std::any_of(overlaps.begin(), overlaps.end(), [&](const Overlap& overlap) {
      return overlap.first == robot && overlap.second == obstacle && overlap.t_begin <= t &&
             t <= overlap.t_end;
    });
  };
  for (std::size_t robot = 0; robot < executed.size(); ++robot) {
    for (std::size_t k = 0; k < obstacles.size(); ++k) {
      for (double t = 0.005; t < 40.0; t += 0.037) {
        const auto leg = std::find_if(obstacles[k].begin(), obstacles[k].end(),
                                      [t](const Leg& l) { return t <= l.t_end; });
        const bool present = leg != obstacles[k].end() && leg->t_begin <= t;
        const double gap = !present ? 1.0
                                    : (sampled_position(fleet, robot, t) - position_at(*leg, t)).norm() -
                                          radii[k] - executed.radii[robot];
        if (std::abs(gap) < 1e-9) continue;
        EXPECT_EQ(overlap_at(robot, k, t), gap < 0.0) << "robot " << robot << " obstacle " << k << " t " << t;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomObstacles, testing::Range(0, 40));

}  // namespace TEST_FILE
}  // namespace fleetplan::core
