#include "core/sipp/cost_to_go.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/bounds/lower_bound.h"
#include "tests/core/support/planning.h"
#include "tests/support/random_problem.h"

namespace fleetplan::core {
namespace TEST_FILE {

using support::robot_at;

constexpr double kPi = std::numbers::pi;

/// The estimate for robot 0 from its start.
CostToGo::Estimate from_start(Planning& p, const StopCondition& stop = StopCondition::never()) {
  const Vertices vertices(p.instance, 0, 0, StopCondition::never());
  CostToGo cost_to_go(vertices);
  return cost_to_go.from(vertices.start(), stop);
}

OccupancyGrid wall() {
  return support::ascii_map({".....",  //
                             "..#..",  //
                             "..#.."});
}

TEST(CostToGo, EqualsStraightLineWithoutObstacles) {
  Planning p(OccupancyGrid(10, 10, 1.0), {robot_at(1.5, 1.5, 2.0).to(5.2, 6.3).speeds(2.0, 1.0)});
  const auto estimate = from_start(p);
  EXPECT_TRUE(estimate.straight);
  EXPECT_DOUBLE_EQ(estimate.seconds, std::hypot(3.7, 4.8) / 2.0) << "without the rotation at the start";
  EXPECT_DOUBLE_EQ(estimate.heading, std::atan2(4.8, 3.7));
}

TEST(CostToGo, IncludesGoalRotationAndAddedWait) {
  PlanOptions options;
  options.wait_before_move = 1.5;
  Planning p(OccupancyGrid(10, 10, 1.0), {robot_at(1.5, 1.5).to(5.5, 1.5, -2.0).speeds(1.0, 1.0)}, options);
  EXPECT_DOUBLE_EQ(from_start(p).seconds, 4.0 + 2.0 + 1.5);
}

TEST(CostToGo, GoesAroundWallAlongLattice) {
  // Up 2 m, right 2 m, down 2 m, with two quarter turns of one second each.
  Planning p(wall(), {robot_at(1.5, 0.5).to(3.5, 0.5, -kPi / 2).radius(0.5)});
  const auto estimate = from_start(p);
  EXPECT_FALSE(estimate.straight);
  EXPECT_NEAR(estimate.seconds, 8.0, 1e-12);
  EXPECT_NEAR(estimate.heading, kPi / 2, 1e-12);
}

TEST(CostToGo, UsesOnlyLatticeMovesWithoutAnyAngle) {
  PlanOptions options;
  options.any_angle = false;
  options.connectivity = 4;
  Planning p(OccupancyGrid(6, 6, 1.0), {robot_at(0.5, 0.5).to(4.5, 3.5)}, options);
  const auto estimate = from_start(p);
  EXPECT_FALSE(estimate.straight);
  EXPECT_GE(estimate.seconds, 7.0 + 1.0) << "4 right, 3 up, a quarter turn";
}

TEST(CostToGo, IsInfiniteIfGoalIsUnreachable) {
  const OccupancyGrid closed = support::ascii_map({"..#..",  //
                                                   "..#..",  //
                                                   "..#.."});
  Planning p(closed, {robot_at(1.5, 0.5).to(3.5, 0.5)});
  EXPECT_EQ(from_start(p).seconds, kForever);
  EXPECT_TRUE(p.state.ways().way_to_goal(0, 1000, p.never).none());
  Planning wide(wall(), {robot_at(1.0, 1.0).to(4.0, 1.0).radius(0.6)});
  EXPECT_EQ(from_start(wide).seconds, kForever) << "too wide for the gap above the wall";
}

TEST(CostToGo, EqualsStraightLineWhenStopped) {
  Planning p(maze(), {robot_at(0.5, 0.5).to(27.5, 8.5)});
  EXPECT_GT(from_start(p).seconds, 90.0);
  EXPECT_NEAR(from_start(p, met()).seconds, std::hypot(27.0, 8.0), 1e-9);
}

TEST(CostToGo, DoesNotDependOnOrderOfQueries) {
  Planning p(maze(), {robot_at(0.5, 0.5).to(27.5, 8.5)});
  const Vertices vertices(p.instance, 0, 0, StopCondition::never());
  CostToGo queried_once(vertices);
  const auto last = queried_once.from(vertices.start(), p.never);
  CostToGo queried_often(vertices);
  for (int v = vertices.count() - 1; v >= 0; --v) {
    if (v != vertices.goals().back().vertex) queried_often.from(v, p.never);
  }
  EXPECT_EQ(queried_often.from(vertices.start(), p.never).seconds, last.seconds);
}

TEST(CostToGo, IsAtLeastLowerBoundOnRandomProblems) {
  const std::uint64_t seed = 31;
  support::Dice dice(seed);
  for (int k = 0; k < 200; ++k) {
    SCOPED_TRACE(testing::Message() << "seed " << seed << ", problem " << k);
    Problem problem = support::random_problem(dice, 1);
    const PlanOptions options = support::random_options(dice, problem);
    Planning p(std::move(problem), options);
    const Robot& robot = p.instance.problem().robots()[0];
    if (!robot.goal || (robot.goal->position - robot.start.position).norm() < 1e-6) continue;
    const auto estimate = from_start(p);
    const double turn = p.instance.body(0).rotation_time(robot.start.theta, estimate.heading);
    const double bound = straight_bound(p.instance, 0);
    ASSERT_GE(estimate.seconds + turn, bound - 1e-8);
    if (estimate.straight) {
      ASSERT_NEAR(estimate.seconds + turn, bound, 1e-8);
    }
  }
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
