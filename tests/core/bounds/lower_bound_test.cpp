#include "core/bounds/lower_bound.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/core/support/planning.h"
#include "tests/support/random_problem.h"

namespace fleetplan::core {
namespace TEST_FILE {

using support::robot_at;

constexpr double kPi = std::numbers::pi;
constexpr Motion kMotion{0.4, 2.0, 0.5, 0.0};

TEST(LowerBound, IsTheStraightLineWithTheRotationsBeforeAndAfterIt) {
  const double slope = std::atan2(4.0, 3.0);
  EXPECT_DOUBLE_EQ(lower_bound(robot_at(1, 1).to(4, 5), kMotion), 2.5 + 2.0 * slope);
  EXPECT_DOUBLE_EQ(lower_bound(robot_at(1, 1).to(4, 5, 0.0), kMotion), 2.5 + 4.0 * slope);
  EXPECT_DOUBLE_EQ(lower_bound(robot_at(1, 1, kPi).to(4, 1, kPi), kMotion), 1.5 + 4.0 * kPi);
  EXPECT_DOUBLE_EQ(lower_bound(robot_at(1, 1, 3.0).to(-3, 1, -3.0), kMotion), 2.0 + 4.0 * (kPi - 3.0));
}

TEST(LowerBound, IsTheRotationForARobotAtItsGoal) {
  EXPECT_EQ(lower_bound(robot_at(1, 1, 2.0).to(1, 1), kMotion), 0.0);
  EXPECT_DOUBLE_EQ(lower_bound(robot_at(1, 1, 2.0).to(1, 1, 1.0), kMotion), 2.0);
}

TEST(LowerBound, AddsOneWaitBeforeTheMove) {
  const Motion motion{0.4, 2.0, 0.5, 1.5};
  EXPECT_DOUBLE_EQ(lower_bound(robot_at(1, 1).to(5, 1), motion), 3.5);
  EXPECT_EQ(lower_bound(robot_at(1, 1).to(1, 1), motion), 0.0) << "no move, no wait";
}

class LowerBoundOfRandomProblems : public testing::TestWithParam<bool> {};

TEST_P(LowerBoundOfRandomProblems, NeverExceedsTheCostOfTheRobotAloneAndIsExactInSight) {
  const std::uint64_t seed = 29;
  support::Dice dice(seed);
  int detours = 0;
  int straight = 0;
  for (int k = 0; k < 250; ++k) {
    SCOPED_TRACE(testing::Message() << "seed " << seed << ", problem " << k);
    Problem problem = support::random_problem(dice, 1);
    PlanOptions options = support::random_options(dice, problem);
    options.any_angle = GetParam();
    Planning p(std::move(problem), options);
    const Robot& robot = p.instance.robot(0);
    if (!robot.goal) continue;
    const auto found = p.state.plan(0, {kForever, 0.0}, p.never).trajectory;
    if (!found) continue;
    const double bound = lower_bound(robot, p.instance.motion(0));
    ASSERT_GE(found->cost, bound - 1e-8);
    const bool seen =
        p.instance.sight().may_sweep(robot.start.position, robot.goal->position, p.instance.motion(0).radius);
    if (seen && GetParam()) {
      ASSERT_NEAR(found->cost, bound, 1e-8);
    }
    ++(found->cost > bound + 1e-6 ? detours : straight);
  }
  EXPECT_GT(detours, 10);
  EXPECT_GT(straight, 10);
}

TEST(LowerBound, AddsLegsServicesAndWaiting) {
  Robot robot = robot_at(1, 1).to(1, 5);
  robot.via = {{{5, 1}, {}, 3.0}, {{5, 5}, kPi / 2, 1.0, 20.0}};
  EXPECT_DOUBLE_EQ(lower_bound(robot, kMotion), 20.0 + 1.0 + kPi + 2.0)
      << "from (5, 5) on: the service at 20 s, a quarter turn, and 4 m";
  robot.via[1].not_before = 0.0;
  EXPECT_DOUBLE_EQ(lower_bound(robot, kMotion), 2.0 + 3.0 + 2.0 + 1.0 + kPi + 2.0)
      << "the heading at the first goal is free";
}

TEST(LowerBound, CountsOnlyWhatIsLeftOfAServiceUnderWay) {
  Robot robot = robot_at(1, 1).to(5, 1);
  robot.via = {{{1, 1}, {}, 3.0}};
  robot.committed = {{Action::Type::wait, 0.0, 2.0, robot.start, robot.start, 0}};
  EXPECT_DOUBLE_EQ(lower_bound(robot, kMotion), 3.0 + 2.0);
}

INSTANTIATE_TEST_SUITE_P(AnyAngle, LowerBoundOfRandomProblems, testing::Bool());

}  // namespace TEST_FILE
}  // namespace fleetplan::core
