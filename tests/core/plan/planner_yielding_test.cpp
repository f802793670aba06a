// Robots that make way when they have nothing to do, and end anywhere that is out of the way.

#include <gtest/gtest.h>

#include <cstddef>
#include <utility>
#include <vector>

#include "tests/support/ascii_map.h"
#include "tests/support/plan_checked.h"
#include "tests/support/problem_builder.h"

namespace fleetplan::core {
namespace TEST_FILE {

using support::plan_checked;
using support::robot_at;

Robot yielding(Robot robot) {
  robot.let_yield();
  return robot;
}

Robot served_for(Robot robot, double seconds) {
  robot.goal->service = seconds;
  return robot;
}

OccupancyGrid corridor_with_bay() {
  return support::ascii_map({"#####.#####",  //
                             "..........."});
}

OccupancyGrid dead_end() { return support::ascii_map({"......"}); }

OccupancyGrid hall() {
  return support::ascii_map({"..........", "..........", "..........", "..........", ".........."});
}

Plan plan_of(OccupancyGrid grid, std::vector<Robot> robots, const PlanOptions& options = {}) {
  return plan_checked(support::make_problem(std::move(grid), std::move(robots)), options);
}

Position end_of(const RobotPlan& plan, const Robot& robot) {
  return plan.actions.empty() ? robot.start.position : plan.actions.back().to.position;
}

TEST(PlannerYielding, ARobotThatNobodyNeedsDoesNotMove) {
  const Plan plan = plan_of(hall(), {yielding(robot_at(5.5, 0.5)), robot_at(0.5, 3.5).to(8.5, 3.5)});
  ASSERT_EQ(plan.plans.size(), 2U);
  EXPECT_TRUE(plan.plans[0].actions.empty());
  EXPECT_EQ(plan.plans[0].cost, 0.0);
}

TEST(PlannerYielding, OthersGoRoundItWhereTheyCan) {
  const Plan plan = plan_of(hall(), {yielding(robot_at(5.5, 2.5)), robot_at(0.5, 2.5).to(9.5, 2.5)});
  ASSERT_EQ(plan.plans.size(), 2U);
  EXPECT_TRUE(plan.plans[0].actions.empty());
}

TEST(PlannerYielding, MakesWayWhereTheWayRoundIsLong) {
  const OccupancyGrid grid = support::ascii_map({".....................",  //
                                                 ".###################.",  //
                                                 ".###################.",  //
                                                 ".###################.",  //
                                                 ".###################.",  //
                                                 "....................."});
  const Plan plan = plan_of(grid, {robot_at(0.5, 0.5).to(20.5, 0.5), yielding(robot_at(19.5, 0.5))});
  ASSERT_EQ(plan.plans.size(), 2U);
  EXPECT_LT(plan.plans[0].cost, 22.0);
  EXPECT_FALSE(plan.plans[1].actions.empty());
}

TEST(PlannerYielding, MakesWayInACorridor) {
  const Robot idle = yielding(robot_at(7.5, 0.5));
  const Plan plan = plan_of(corridor_with_bay(), {robot_at(0.5, 0.5).to(10.5, 0.5), idle});
  ASSERT_EQ(plan.plans.size(), 2U) << "a parked robot would leave no way";
  EXPECT_GT(plan.plans[1].cost, 0.0);
  EXPECT_NEAR((end_of(plan.plans[1], idle) - Position(5.5, 1.5)).norm(), 0.0, 1e-9) << "the only bay";
}

TEST(PlannerYielding, ComesBackIfThatIsItsGoal) {
  const Robot back = robot_at(7.5, 0.5).to(7.5, 0.5, 0.0);
  const Plan plan = plan_of(corridor_with_bay(), {robot_at(0.5, 0.5).to(10.5, 0.5), back});
  ASSERT_EQ(plan.plans.size(), 2U);
  EXPECT_NEAR((end_of(plan.plans[1], back) - back.start.position).norm(), 0.0, 1e-9);
}

TEST(PlannerYielding, LeavesTheGoalOfAnother) {
  for (const double inflation : {0.0, 0.05}) {
    PlanOptions options;
    options.inflation = inflation;
    const Robot idle = yielding(robot_at(5.5, 2.5));
    const Plan plan = plan_of(hall(), {robot_at(0.5, 2.5).to(5.5, 2.5), idle}, options);
    ASSERT_EQ(plan.plans.size(), 2U);
    EXPECT_GE((end_of(plan.plans[1], idle) - Position(5.5, 2.5)).norm(), 0.8);
  }
}

TEST(PlannerYielding, OneMakesWayForAnother) {
  // The robot in the corridor can only go where the other one stands.
  const Plan plan =
      plan_of(support::ascii_map({"#####.#####",  //
                                  "#####.#####",  //
                                  "..........."}),
              {robot_at(0.5, 0.5).to(10.5, 0.5), yielding(robot_at(7.5, 0.5)), yielding(robot_at(5.5, 1.5))});
  EXPECT_EQ(plan.plans.size(), 3U);
}

TEST(PlannerYielding, ARobotWithoutARoomStays) {
  const Plan plan = plan_of(dead_end(), {robot_at(0.5, 0.5).to(5.5, 0.5), yielding(robot_at(5.5, 0.5))});
  ASSERT_EQ(plan.plans.size(), 1U);
  EXPECT_EQ(plan.plans[0].robot, 1U);
  EXPECT_TRUE(plan.plans[0].actions.empty());
  ASSERT_EQ(plan.unplanned.size(), 1U);
  EXPECT_EQ(plan.unplanned[0].reason, Unplanned::Reason::blocked_by_robots);
  EXPECT_EQ(plan.unplanned[0].blocked_by, RobotList({1}));
}

TEST(PlannerYielding, StaysAtItsLastGoalIfNobodyNeedsIt) {
  const Robot robot = served_for(robot_at(0.5, 2.5).to(5.5, 2.5), 3.0);
  const Plan with = plan_of(hall(), {yielding(robot)});
  const Plan without = plan_of(hall(), {robot});
  ASSERT_EQ(with.plans.size(), 1U);
  EXPECT_EQ(with.plans[0].cost, without.plans[0].cost);
  EXPECT_EQ(with.plans[0].actions.size(), without.plans[0].actions.size());
}

TEST(PlannerYielding, SeveralRobotsShareALastGoal) {
  std::vector<Robot> robots;
  for (int k = 0; k < 3; ++k) {
    robots.push_back(yielding(served_for(robot_at(0.5 + k, 0.5).to(8.5, 2.5), 20.0)));
  }
  const Plan plan = plan_of(hall(), robots);
  ASSERT_EQ(plan.plans.size(), 3U);
  for (const RobotPlan& one : plan.plans) ASSERT_EQ(one.visits.size(), 2U) << "the goal, and anywhere";
  EXPECT_LT(plan.plans[2].visits[0].t_leave, plan.plans[1].visits[0].t_arrive) << "the nearest comes first";
  EXPECT_LT(plan.plans[1].visits[0].t_leave, plan.plans[0].visits[0].t_arrive);
}

TEST(PlannerYielding, AQueueLeavesTheWayOutOfAStationFree) {
  // The station is a bay. A robot that waits in front of it would lock the other robot in.
  const OccupancyGrid grid = support::ascii_map({"####.####",  //
                                                 ".........",  //
                                                 "........."});
  std::vector<Robot> robots;
  for (int k = 0; k < 3; ++k) {
    robots.push_back(yielding(served_for(robot_at(0.5 + k, 0.5).to(4.5, 2.5), 20.0)));
  }
  EXPECT_EQ(plan_of(grid, robots).plans.size(), 3U);
}

TEST(PlannerYielding, OneThatYieldsSharesTheLastGoalOfOneThatStays) {
  const Plan plan = plan_of(hall(), {served_for(robot_at(0.5, 0.5).to(8.5, 2.5), 5.0),
                                     yielding(served_for(robot_at(0.5, 2.5).to(8.5, 2.5), 5.0))});
  ASSERT_EQ(plan.plans.size(), 2U);
  EXPECT_LT(plan.plans[1].visits[0].t_leave, plan.plans[0].visits[0].t_arrive);
}

TEST(PlannerYielding, WithAHorizonARobotThatIsStuckBehindItIsLetPass) {
  PlanOptions options;
  options.horizon = 12.0;
  const std::vector<Robot> robots{robot_at(0.5, 0.5).to(10.5, 0.5), yielding(robot_at(4.5, 0.5))};
  const Problem problem = support::make_problem(corridor_with_bay(), robots);
  const Plan plan = core::plan(problem, options, StopCondition::never());
  EXPECT_TRUE(check_plan(problem, options, plan, StopCondition::never())->valid());
  ASSERT_EQ(plan.plans.size(), 2U);
  EXPECT_FALSE(plan.plans[0].is_stuck);
  EXPECT_FALSE(plan.plans[1].actions.empty());
}

TEST(PlannerYielding, KeepsAPreviousPlanThatRestsElsewhere) {
  const std::vector<Robot> first{robot_at(0.5, 0.5).to(10.5, 0.5), yielding(robot_at(7.5, 0.5))};
  const Plan before = plan_of(corridor_with_bay(), first);
  ASSERT_EQ(before.plans.size(), 2U);
  std::vector<Robot> robots = first;
  for (const RobotPlan& one : before.plans) robots[one.robot].previous = one.actions;
  const Plan after = plan_of(corridor_with_bay(), robots);
  ASSERT_EQ(after.plans.size(), 2U);
  EXPECT_EQ(after.plans[1].cost, before.plans[1].cost);
}

TEST(PlannerYielding, MakesWayForCommittedMotion) {
  const Robot driver = robot_at(0.5, 0.5).drives(10.5, 0.5).to(10.5, 0.5);
  const Plan plan = plan_of(corridor_with_bay(), {driver, yielding(robot_at(4.5, 0.5))});
  EXPECT_EQ(plan.plans.size(), 2U);
  EXPECT_TRUE(plan.unavoidable.empty()) << "it is out of the way in time";
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
