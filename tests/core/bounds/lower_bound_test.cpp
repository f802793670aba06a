#include "core/bounds/lower_bound.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <random>

#include "core/geometry/position.h"
#include "tests/core/support/planning.h"
#include "tests/support/random_problem.h"

namespace fleetplan::core {
namespace TEST_FILE {

using support::robot_at;

constexpr double kPi = std::numbers::pi;

/// Of a robot with 2 m/s and 0.5 rad/s.
double bound_of(Robot robot, double wait_before_move = 0.0) {
  robot.linear_speed = 2.0;
  robot.angular_speed = 0.5;
  PlanOptions options;
  options.wait_before_move = wait_before_move;
  return lower_bound(itinerary_of(robot), bodies_of(robot, options, 0));
}

TEST(LowerBound, IsTheStraightLineWithTheRotationsBeforeAndAfterIt) {
  const double slope = std::atan2(4.0, 3.0);
  EXPECT_DOUBLE_EQ(bound_of(robot_at(1, 1).to(4, 5)), 2.5 + 2.0 * slope);
  EXPECT_DOUBLE_EQ(bound_of(robot_at(1, 1).to(4, 5, 0.0)), 2.5 + 4.0 * slope);
  EXPECT_DOUBLE_EQ(bound_of(robot_at(1, 1, kPi).to(4, 1, kPi)), 1.5 + 4.0 * kPi);
  EXPECT_DOUBLE_EQ(bound_of(robot_at(1, 1, 3.0).to(-3, 1, -3.0)), 2.0 + 4.0 * (kPi - 3.0));
}

TEST(LowerBound, IsTheRotationForARobotAtItsGoal) {
  EXPECT_EQ(bound_of(robot_at(1, 1, 2.0).to(1, 1)), 0.0);
  EXPECT_DOUBLE_EQ(bound_of(robot_at(1, 1, 2.0).to(1, 1, 1.0)), 2.0);
}

TEST(LowerBound, AddsOneWaitBeforeTheMove) {
  EXPECT_DOUBLE_EQ(bound_of(robot_at(1, 1).to(5, 1), 1.5), 3.5);
  EXPECT_EQ(bound_of(robot_at(1, 1).to(1, 1), 1.5), 0.0) << "no move, no wait";
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
    const Robot& robot = p.instance.problem().robots()[0];
    if (!robot.goal) continue;
    const auto found = p.state.plan(0, {kForever, 0.0}, p.never).trajectory;
    if (!found) continue;
    const double bound = straight_bound(p.instance, 0);
    ASSERT_GE(found->cost, bound - 1e-8);
    const bool seen = p.instance.sight_past_walls().may_sweep(robot.start.position, robot.goal->position,
                                                              p.instance.body(0).wall_radius);
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
  EXPECT_DOUBLE_EQ(bound_of(robot), 20.0 + 1.0 + kPi + 2.0)
      << "from (5, 5) on: the service at 20 s, a quarter turn, and 4 m";
  robot.via[1].not_before = 0.0;
  EXPECT_DOUBLE_EQ(bound_of(robot), 2.0 + 3.0 + 2.0 + 1.0 + kPi + 2.0)
      << "the heading at the first goal is free";
}

TEST(LowerBound, DrivesEachLegWithTheLoadThatItHasThere) {
  Robot robot = robot_at(1, 1).to(9, 1);
  robot.via = {{{5, 1}, {}, 1.0}};
  robot.via[0].linear_speed_after = 0.5;
  EXPECT_DOUBLE_EQ(bound_of(robot), 4.0 / 2.0 + 1.0 + 4.0 / 0.5);
  robot.linear_acceleration = robot.linear_deceleration = 1.0;
  robot.via[0].linear_acceleration_after = 0.25;
  EXPECT_DOUBLE_EQ(bound_of(robot), (4.0 / 2.0 + 2.0) + 1.0 + (4.0 / 0.5 + 2.0))
      << "and needs time to start and stop";
}

TEST(LowerBound, CountsOnlyWhatIsLeftOfAServiceUnderWay) {
  Robot robot = robot_at(1, 1).to(5, 1);
  robot.via = {{{1, 1}, {}, 3.0}};
  robot.committed = {{Action::Type::wait, 0.0, 2.0, robot.start, robot.start, 0}};
  EXPECT_DOUBLE_EQ(bound_of(robot), 3.0 + 2.0);
}

INSTANTIATE_TEST_SUITE_P(AnyAngle, LowerBoundOfRandomProblems, testing::Bool());

Body body(double linear_speed, double angular_speed) {
  Body body;
  body.linear_speed = linear_speed;
  body.angular_speed = angular_speed;
  body.may_reverse = true;
  return body;
}

TEST(ReverseBound, IsTheLengthForARobotThatLooksAlongTheLine) {
  const Body robot = body(2.0, 0.5);
  EXPECT_DOUBLE_EQ(reverse_bound(6.0, 0.3, 0.3, 0.3, robot), 3.0);
  EXPECT_NEAR(reverse_bound(6.0, 0.3, 0.3 - kPi, 0.3 - kPi, robot), 3.0, 1e-12) << "backwards";
  EXPECT_DOUBLE_EQ(reverse_bound(6.0, 0.3, std::nullopt, std::nullopt, robot), 3.0);
  EXPECT_DOUBLE_EQ(reverse_bound(6.0, 0.3, std::nullopt, 0.3, robot), 3.0);
}

TEST(ReverseBound, TurnsIntoTheLineIfThatIsQuick) {
  const Body robot = body(0.01, 10.0);
  EXPECT_NEAR(reverse_bound(1.0, 0.0, 1.0, std::nullopt, robot), 100.0 + 0.1, 0.01);
  EXPECT_NEAR(reverse_bound(1.0, 0.0, kPi - 1.0, std::nullopt, robot), 100.0 + 0.1, 0.01) << "backwards";
}

TEST(ReverseBound, GoesBesideTheLineIfTurningIsSlow) {
  const Body robot = body(100.0, 0.01);
  EXPECT_NEAR(reverse_bound(1.0, 0.0, kPi / 3.0, kPi / 3.0, robot), 0.02, 1e-3);
  const double opposite = reverse_bound(1.0, 0.0, kPi / 2.0, -kPi / 2.0, robot);
  EXPECT_GE(opposite, kPi / 0.01) << "it has to turn anyway";
  EXPECT_LE(opposite, kPi / 0.01 + 0.02);
}

TEST(ReverseBound, IsNeverMoreThanTheStraightCostForwards) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> heading(-kPi, kPi);
  std::uniform_real_distribution<double> exponent(-2.0, 2.0);
  for (int k = 0; k < 2000; ++k) {
    Body robot = body(std::pow(10.0, exponent(random)), std::pow(10.0, exponent(random)));
    Goal goal{{std::pow(10.0, exponent(random)), 0.0}, std::nullopt};
    if (k % 2 == 0) goal.theta = heading(random);
    const Pose from{{0.0, 0.0}, heading(random)};
    const double both = straight_cost(from, goal, robot);
    robot.may_reverse = false;
    EXPECT_LE(both, straight_cost(from, goal, robot) + 1e-12);
  }
}

/// Robots that go forwards and backwards at random never take less time.
TEST(ReverseBound, HoldsForRandomPaths) {
  std::mt19937 random(6);
  std::uniform_real_distribution<double> heading(-kPi, kPi);
  std::uniform_real_distribution<double> length(-3.0, 3.0);
  std::uniform_real_distribution<double> exponent(-2.0, 2.0);
  for (int k = 0; k < 5000; ++k) {
    const Body robot = body(std::pow(10.0, exponent(random)), std::pow(10.0, exponent(random)));
    const double spread = std::pow(10.0, exponent(random) - 1.0);
    const double from = heading(random);
    Position at(0.0, 0.0);
    double theta = from;
    double seconds = 0.0;
    for (int move = 1 + k % 4; move > 0; --move) {
      const double next = normalize_angle(theta + spread * heading(random));
      const double metres = length(random);
      seconds += robot.rotation_time(theta, next) + std::abs(metres) / robot.linear_speed;
      at += metres * Position(std::cos(next), std::sin(next));
      theta = next;
    }
    const double distance = at.norm();
    if (distance < 1e-6) continue;
    const double bound = reverse_bound(distance, std::atan2(at.y(), at.x()), from, theta, robot);
    EXPECT_LE(bound, seconds * (1.0 + 1e-9) + 1e-9);
  }
}

/// The best of many deviations from the line.
TEST(ReverseBound, IsTheBestTradeOfTurnsForLength) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> angle(0.0, kPi / 2.0);
  std::uniform_real_distribution<double> exponent(-1.0, 1.0);
  for (int k = 0; k < 300; ++k) {
    const Body robot = body(1.0, std::pow(10.0, exponent(random)));
    const double from = angle(random);
    const double bound = reverse_bound(1.0, 0.0, from, std::nullopt, robot);
    double best = std::min(from / robot.angular_speed + 1.0, 1.0 / std::cos(from));
    for (double aside = 0.0; aside < from; aside += 1e-4) {
      best = std::min(best, (from - aside) / robot.angular_speed + 1.0 / std::cos(aside));
    }
    EXPECT_NEAR(bound, best, 1e-6);
  }
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
