// Plans of robots whose radius changes at goals.

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

#include "tests/support/ascii_map.h"
#include "tests/support/plan_checked.h"
#include "tests/support/problem_builder.h"

namespace fleetplan::core {
namespace TEST_FILE {

using support::ascii_map;
using support::plan_checked;
using support::robot_at;

/// Visits this place before its last goal and leaves it with another radius.
Robot with_load(Robot robot, double x, double y, double radius_after, double service = 0.0) {
  robot.via.push_back({Position(x, y), std::nullopt, service, 0.0, radius_after});
  return robot;
}

/// A way of one cell above, and a longer one of three cells below.
OccupancyGrid two_ways() {
  return ascii_map({"##########",  //
                    "..........",  //
                    "..######..",  //
                    "..######..",  //
                    "..........",  //
                    "..........",  //
                    ".........."});
}

bool drives_below(const RobotPlan& plan, double y, double from) {
  return std::any_of(plan.actions.begin(), plan.actions.end(), [&](const Action& action) {
    return action.t_start >= from && action.to.position.y() < y;
  });
}

TEST(PlannerLoads, ALoadedRobotTakesTheWideWay) {
  const Robot robot = robot_at(0.5, 5.5).to(9.0, 5.0);
  const Problem empty = support::make_problem(two_ways(), {with_load(robot, 1.0, 5.0, 0.4)});
  EXPECT_FALSE(drives_below(plan_checked(empty).plans.at(0), 3.0, 0.0));
  const Problem loaded = support::make_problem(two_ways(), {with_load(robot, 1.0, 5.0, 0.9)});
  EXPECT_TRUE(drives_below(plan_checked(loaded).plans.at(0), 3.0, 0.0));
}

TEST(PlannerLoads, ARobotThatHasPutItsLoadDownTakesTheNarrowWay) {
  Robot robot = robot_at(1.0, 1.5).to(9.5, 5.5);
  robot.radius = 0.9;
  const Problem problem = support::make_problem(two_ways(), {with_load(robot, 1.0, 5.0, 0.4)});
  const Plan plan = plan_checked(problem);
  ASSERT_EQ(plan.plans.size(), 1u);
  EXPECT_FALSE(drives_below(plan.plans[0], 3.0, plan.plans[0].visits.at(0).t_leave));
}

TEST(PlannerLoads, ALoadThatFitsThroughNoWayMakesTheGoalUnreachable) {
  const OccupancyGrid gate = ascii_map({"....##....",  //
                                        "....##....",  //
                                        "..........",  //
                                        "....##....",  //
                                        "....##...."});
  const Robot robot = robot_at(1.5, 2.5).to(8.5, 2.5);
  EXPECT_EQ(plan_checked(support::make_problem(gate, {with_load(robot, 2.0, 2.5, 0.5)})).plans.size(), 1u);
  const Plan plan = plan_checked(support::make_problem(gate, {with_load(robot, 2.0, 2.5, 0.8)}));
  ASSERT_EQ(plan.unplanned.size(), 1u);
  EXPECT_EQ(plan.unplanned[0].reason, Unplanned::Reason::goal_unreachable);
}

TEST(PlannerLoads, ALoadThatDoesNotFitInflatedBlocksTheGoal) {
  PlanOptions options;
  options.inflation = 0.2;
  const OccupancyGrid hall(10, 3, 1.0);
  const Robot robot = robot_at(1.5, 1.5).to(8.5, 1.5);
  const Plan plan = plan_checked(support::make_problem(hall, {with_load(robot, 5.0, 1.5, 1.4)}), options);
  ASSERT_EQ(plan.unplanned.size(), 1u);
  EXPECT_EQ(plan.unplanned[0].reason, Unplanned::Reason::goal_blocked);
}

TEST(PlannerLoads, TheServiceEndsWhenThereIsRoomForTheLoad) {
  // Another robot stands beside the goal until t = 12.
  std::vector<Robot> robots{with_load(robot_at(1.5, 4.5).to(18.5, 4.5), 8.5, 4.5, 1.2, 1.0),
                            robot_at(8.5, 5.7).waits(12.0).drives(8.5, 8.5).to(8.5, 8.5)};
  const Problem problem = support::make_problem(OccupancyGrid(20, 10, 1.0), robots);
  const Plan plan = plan_checked(problem);
  ASSERT_EQ(plan.plans.size(), 2u);
  const double t_leave = plan.plans[0].visits.at(0).t_leave;
  EXPECT_GT(t_leave, 12.0);
  EXPECT_LT(t_leave, 14.5);
}

TEST(PlannerLoads, TwoRobotsThatGrowKeepApart) {
  std::vector<Robot> robots{with_load(robot_at(0.5, 4.5).to(18.5, 4.5), 4.5, 4.5, 1.0),
                            with_load(robot_at(19.5, 4.5).to(1.5, 4.5), 15.5, 4.5, 1.0)};
  const Problem problem = support::make_problem(OccupancyGrid(20, 9, 1.0), robots);
  EXPECT_TRUE(plan_checked(problem).unplanned.empty());
}

TEST(PlannerLoads, TheLastGoalMayChangeTheRadius) {
  Robot robot = robot_at(1.5, 4.5).to(8.5, 4.5);
  robot.goal->radius_after = 1.3;
  robot.goal->service = 2.0;
  // Parked where the load does not reach; passes the goal, so the robot has to wait for it.
  const Problem problem = support::make_problem(
      OccupancyGrid(12, 9, 1.0), {robot, robot_at(8.5, 7.0).waits(10.0).drives(8.5, 8.5).to(8.5, 8.5)});
  const Plan plan = plan_checked(problem);
  ASSERT_EQ(plan.plans.size(), 2u);
  EXPECT_NEAR(plan.plans[0].cost, 9.0, 1e-6) << "there is room";
  Robot crowded = robot_at(8.5, 6.0).waits(10.0).drives(8.5, 8.5).to(8.5, 8.5);
  const Plan late = plan_checked(support::make_problem(OccupancyGrid(12, 9, 1.0), {robot, crowded}));
  ASSERT_EQ(late.plans.size(), 2u);
  EXPECT_GT(late.plans[0].cost, 10.0);
}

TEST(PlannerLoads, LastGoalsDoNotOverlapWithTheLastRadii) {
  Robot robot = robot_at(1.5, 1.5).to(5.0, 1.5);
  const Robot other = robot_at(1.5, 3.5).to(6.5, 1.5);
  const auto faults = [&](const Robot& first) {
    auto made = Problem::create(OccupancyGrid(10, 6, 1.0), {first, other}, StopCondition::never());
    const auto* found = std::get_if<ProblemFaults>(&made);
    return found != nullptr ? found->listed : std::vector<ProblemFault>{};
  };
  EXPECT_TRUE(faults(robot).empty());
  robot.goal->radius_after = 1.2;
  ASSERT_EQ(faults(robot).size(), 1u);
  EXPECT_EQ(faults(robot)[0].kind, ProblemFault::Kind::goals_overlap);
  EXPECT_NEAR(faults(robot)[0].gap, -0.1, 1e-9);
}

TEST(PlannerLoads, CommittedMotionThatContainsAServiceChangesTheRadius) {
  Robot robot = robot_at(1.5, 4.5).drives(4.5, 4.5).waits(5.0).drives(7.5, 4.5).to(18.5, 4.5);
  robot = with_load(robot, 4.5, 4.5, 1.2, 2.0);
  // There is room for the bare robot, but not for the load.
  const auto made =
      Problem::create(OccupancyGrid(20, 9, 1.0), {robot, robot_at(6.5, 5.7)}, StopCondition::never());
  const auto* found = std::get_if<ProblemFaults>(&made);
  ASSERT_NE(found, nullptr);
  EXPECT_EQ(found->listed.at(0).kind, ProblemFault::Kind::committed_collision);
  const Problem free = support::make_problem(OccupancyGrid(20, 9, 1.0), {robot, robot_at(6.5, 7.0)});
  EXPECT_TRUE(plan_checked(free).unplanned.empty());
}

TEST(PlannerLoads, ImprovementAndKeptPlansKeepTheRadii) {
  std::vector<Robot> robots{with_load(robot_at(0.5, 4.5).to(18.5, 4.5), 4.5, 4.5, 1.0, 1.0),
                            with_load(robot_at(19.5, 4.5).to(1.5, 4.5), 15.5, 4.5, 1.0, 1.0),
                            with_load(robot_at(9.5, 1.0).to(9.5, 8.0), 9.5, 3.5, 0.2, 1.0)};
  PlanOptions options;
  options.mode = PlanOptions::Mode::anytime;
  options.max_iterations = 50;
  const Problem problem = support::make_problem(OccupancyGrid(20, 9, 1.0), robots);
  const Plan plan = plan_checked(problem, options);
  ASSERT_TRUE(plan.unplanned.empty());
  for (const RobotPlan& each : plan.plans) robots[each.robot].previous = each.actions;
  const Plan again = plan_checked(support::make_problem(OccupancyGrid(20, 9, 1.0), robots));
  ASSERT_TRUE(again.unplanned.empty());
  for (std::size_t i = 0; i < robots.size(); ++i) EXPECT_EQ(again.plans[i].cost, plan.plans[i].cost);
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
