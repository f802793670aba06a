// Plans of robots that may translate backwards.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "tests/support/ascii_map.h"
#include "tests/support/plan_checked.h"
#include "tests/support/problem_builder.h"
#include "tests/support/random_problem.h"

namespace fleetplan::core {
namespace TEST_FILE {

using support::plan_checked;
using support::robot_at;
using Type = Action::Type;

constexpr double kPi = std::numbers::pi;

Robot reversing(Robot robot) {
  robot.may_reverse = true;
  return robot;
}

TEST(PlannerReverse, ARobotBacksOutOfADeadEnd) {
  const OccupancyGrid corridor = support::ascii_map({"##########",  //
                                                     "..........",  //
                                                     "##########"});
  const Robot robot = robot_at(9.5, 1.5, 0.0).to(0.5, 1.5);
  const Plan turned = plan_checked(support::make_problem(corridor, {robot}));
  EXPECT_NEAR(turned.plans[0].cost, 11.0, 1e-9);
  const Plan plan = plan_checked(support::make_problem(corridor, {reversing(robot)}));
  ASSERT_EQ(plan.plans.size(), 1u);
  EXPECT_NEAR(plan.plans[0].cost, 9.0, 1e-9);
  EXPECT_NEAR(plan.plans[0].lower_bound, 9.0, 1e-9);
  ASSERT_EQ(plan.plans[0].actions.size(), 1u);
  const Action& back = plan.plans[0].actions[0];
  EXPECT_EQ(back.type, Type::translate);
  EXPECT_TRUE(back.reverse);
  EXPECT_EQ(back.from.theta, 0.0);
  EXPECT_EQ(back.to.theta, 0.0);
}

TEST(PlannerReverse, TheHeadingAtTheGoalDecidesTheDirection) {
  const OccupancyGrid hall(10, 10, 1.0);
  const Robot robot = robot_at(1.5, 5.5, kPi / 2.0).to(8.5, 5.5, kPi);
  const Plan plan = plan_checked(support::make_problem(hall, {reversing(robot)}));
  EXPECT_NEAR(plan.plans[0].cost, 7.0 + 1.0, 1e-6) << "a quarter turn to the left, then back";
}

TEST(PlannerReverse, IsAsGoodAroundCorners) {
  const OccupancyGrid corner = support::ascii_map({"..........",  //
                                                   "..........",  //
                                                   "########..",  //
                                                   "########..",  //
                                                   "########.."});
  const Robot ahead = robot_at(0.5, 3.5, 0.0).to(9.0, 0.5, -kPi / 2.0);
  const Robot back = robot_at(0.5, 3.5, kPi).to(9.0, 0.5, kPi / 2.0);
  const Plan forwards = plan_checked(support::make_problem(corner, {ahead}));
  const Plan backwards = plan_checked(support::make_problem(corner, {reversing(back)}));
  EXPECT_NEAR(backwards.plans[0].cost, forwards.plans[0].cost, 0.02 * forwards.plans[0].cost);
  for (const Action& action : backwards.plans[0].actions) {
    EXPECT_EQ(action.reverse, action.type == Type::translate);
  }
}

TEST(PlannerReverse, MovesForwardsAndBackwardsAreNotJoined) {
  const OccupancyGrid hall(10, 3, 1.0);
  Robot robot = reversing(robot_at(2.5, 1.5, 0.0).to(1.5, 1.5, 0.0).speeds(1.0, 0.01));
  robot.via = {Goal{Position(6.5, 1.5), 0.0}};
  PlanOptions options;
  options.wait_before_move = 2.0;
  const Plan plan = plan_checked(support::make_problem(hall, {robot}), options);
  ASSERT_EQ(plan.plans.size(), 1u);
  const std::vector<Action>& actions = plan.plans[0].actions;
  ASSERT_EQ(actions.size(), 4u);
  EXPECT_FALSE(actions[1].reverse);
  EXPECT_EQ(actions[2].type, Type::wait);
  EXPECT_TRUE(actions[3].reverse);
  EXPECT_NEAR(plan.plans[0].cost, 2.0 + 4.0 + 2.0 + 5.0, 1e-9);
}

TEST(PlannerReverse, ACommittedMoveIsFollowedByOneBackwards) {
  const OccupancyGrid hall(10, 3, 1.0);
  const Robot robot = reversing(robot_at(2.5, 1.5, 0.0).drives(6.5, 1.5).to(1.5, 1.5).speeds(1.0, 0.01));
  const Plan plan = plan_checked(support::make_problem(hall, {robot}));
  ASSERT_EQ(plan.plans[0].actions.size(), 2u);
  EXPECT_FALSE(plan.plans[0].actions[0].reverse);
  EXPECT_TRUE(plan.plans[0].actions[1].reverse);
}

TEST(PlannerReverse, ALoneRobotIsNoSlowerThanOneThatMayNot) {
  support::Dice dice(11);
  for (int k = 0; k < 40; ++k) {
    const Problem problem = support::random_problem(dice, 1);
    if (!problem.robots()[0].goal) continue;
    std::vector<Robot> robots = problem.robots();
    robots[0].may_reverse = true;
    const Problem both = support::make_problem(problem.grid(), robots);
    const Plan before = plan_checked(problem);
    const Plan plan = plan_checked(both);
    ASSERT_EQ(plan.plans.size(), before.plans.size());
    if (plan.plans.empty()) continue;
    EXPECT_LE(plan.plans[0].cost, 1.1 * before.plans[0].cost + 1e-9) << "problem " << k;
  }
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
