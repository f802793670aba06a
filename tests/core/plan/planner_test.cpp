#include "core/plan/planner.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <numbers>

#include "core/runtime/stop_condition.h"
#include "tests/core/support/planning.h"
#include "tests/support/ascii_map.h"
#include "tests/support/expect_bounds.h"
#include "tests/support/expect_safe.h"
#include "tests/support/problem_builder.h"

namespace fleetplan::core {
namespace TEST_FILE {

using support::expect_safe;
using support::robot_at;
using Mode = PlanOptions::Mode;
using Reason = Unplanned::Reason;
using Robots = std::vector<std::size_t>;

constexpr double kPi = std::numbers::pi;

/// The plan, after the checker accepted it, with every robot in it once.
Plan checked_plan(const Problem& problem, const PlanOptions& options = {},
                  const StopCondition& stop = StopCondition::never()) {
  Plan plan = core::plan(problem, options, stop);
  expect_safe(problem, plan, options.inflation);
  EXPECT_EQ(plan.plans.size() + plan.unplanned.size(), problem.robots().size());
  support::expect_bounded(plan);
  return plan;
}

void expect_unplanned(const Plan& plan, std::size_t index, Reason reason, const Robots& blocked_by) {
  for (const Unplanned& robot : plan.unplanned) {
    if (robot.robot != index) continue;
    EXPECT_EQ(static_cast<int>(robot.reason), static_cast<int>(reason)) << robot.detail;
    EXPECT_EQ(robot.blocked_by, blocked_by);
    return;
  }
  ADD_FAILURE() << "robot " << index << " has a plan";
}

TEST(Planner, PlansALoneRobotAlongTheStraightLine) {
  const Problem problem = support::make_problem(OccupancyGrid(10, 10, 1.0),
                                                {robot_at(1.5, 1.5).to(4.5, 5.5, kPi).speeds(2.0, kPi / 4)});
  const Plan plan = checked_plan(problem);
  ASSERT_EQ(plan.plans.size(), 1u);
  EXPECT_NEAR(plan.plans[0].cost, 2.5 + 4.0, 1e-9) << "5 m, and rotations of pi in total";
  EXPECT_NEAR(plan.plans[0].lower_bound, plan.plans[0].cost, 1e-9);
  EXPECT_EQ(plan.objectives.flowtime, plan.plans[0].cost);
  EXPECT_EQ(plan.objectives.makespan, plan.plans[0].cost);
  EXPECT_TRUE(plan.deterministic);
  EXPECT_EQ(plan.search.attempts, 1);
  EXPECT_EQ(plan.search.improvements, 0);
}

/// Two robots that swap places. The bay is nearer to the second one, which has time to enter it.
Problem swap_with_bay() {
  return support::make_problem(support::ascii_map({"######.##",  //
                                                   "........."}),
                               {robot_at(0.5, 0.5).to(8.5, 0.5), robot_at(8.5, 0.5, kPi).to(0.5, 0.5)});
}

TEST(Planner, SwapsTwoRobotsInACorridorWithAPassingBay) {
  const Plan plan = checked_plan(swap_with_bay());
  EXPECT_TRUE(plan.unplanned.empty());
  EXPECT_GT(plan.objectives.makespan, 9.0);
  EXPECT_LE(plan.objectives.makespan, 6.0 + 2.0 + 2.0 + 6.0) << "meet, leave the bay, turn, continue";
}

TEST(Planner, DelaysOneRobotWhereTheOtherIsTooLateForTheBay) {
  // The robot that is planned first leaves at once and reaches the bay no later than the other robot.
  const Problem problem =
      support::make_problem(support::ascii_map({"####.####",  //
                                                "........."}),
                            {robot_at(0.5, 0.5).to(8.5, 0.5), robot_at(8.5, 0.5, kPi).to(0.5, 0.5)});
  const Plan plan = checked_plan(problem);
  EXPECT_TRUE(plan.unplanned.empty());
  EXPECT_TRUE(plan.deterministic);
}

/// Robots 0 and 1 are at their goals and block the only path of the others; each has a bay beside it.
Problem blocked_by_robots_at_goals(bool both_ways) {
  std::vector<Robot> robots{robot_at(4.5, 0.5).to(4.5, 0.5, 0.0), robot_at(8.5, 0.5).to(8.5, 0.5, 0.0)};
  for (const double x : {0.5, 1.5, 2.5}) robots.push_back(robot_at(x, 0.5).to(x + 9.5, 0.5));
  if (both_ways) robots.push_back(robot_at(12.5, 1.5, kPi).to(0.5, 1.5));
  return support::make_problem(support::ascii_map({".###.###.####",  //
                                                   ".###.###.###.",  //
                                                   "............."}),
                               robots);
}

TEST(Planner, MovesRobotsAwayFromTheirGoalsForOthersToPass) {
  for (const bool both_ways : {false, true}) {
    const Plan plan = checked_plan(blocked_by_robots_at_goals(both_ways));
    ASSERT_TRUE(plan.unplanned.empty()) << both_ways;
    for (const std::size_t robot : {0u, 1u})
      EXPECT_GT(plan.plans[robot].cost, 2.0) << "into its bay and back";
    EXPECT_TRUE(plan.deterministic);
  }
}

TEST(Planner, PlansOneOfTwoRobotsInACorridorWithoutABay) {
  const Problem problem = support::make_problem(
      OccupancyGrid(9, 1, 1.0), {robot_at(0.5, 0.5).to(5.5, 0.5), robot_at(3.5, 0.5).to(1.5, 0.5)});
  const Plan plan = checked_plan(problem);
  ASSERT_EQ(plan.unplanned.size(), 1u);
  const std::size_t unplanned = plan.unplanned[0].robot;
  expect_unplanned(plan, unplanned, Reason::blocked_by_robots, {1 - unplanned});
  EXPECT_TRUE(plan.deterministic);
}

TEST(Planner, BoundsTheCostOfEachRobotByItsPathAlone) {
  const Problem problem = support::make_problem(
      support::ascii_map({"........",  //
                          ".###....",  //
                          "........"}),
      {robot_at(2.5, 0.5).to(2.5, 2.5).radius(0.2), robot_at(0.5, 0.5).to(4.5, 0.5).radius(0.2),
       robot_at(7.5, 2.5), robot_at(7.5, 1.5, 1.0).to(7.5, 1.5), robot_at(7.5, 0.5).to(7.5, 0.5, 1.0)});
  const Plan plan = checked_plan(problem);
  ASSERT_EQ(plan.plans.size(), 5u);
  EXPECT_GT(plan.plans[0].lower_bound, 4.0) << "around the wall";
  EXPECT_NEAR(plan.plans[1].lower_bound, 4.0, 1e-9) << "straight through the first robot";
  EXPECT_EQ(plan.plans[2].lower_bound, 0.0) << "parked";
  EXPECT_EQ(plan.plans[3].lower_bound, 0.0) << "at its goal already";
  EXPECT_EQ(plan.plans[4].lower_bound, plan.plans[4].cost) << "only turns";
  EXPECT_GT(plan.plans[4].lower_bound, 0.0);
}

TEST(Planner, PlansAroundParkedRobots) {
  const Problem problem = support::make_problem(
      OccupancyGrid(9, 5, 1.0), {robot_at(4.5, 2.5), robot_at(0.5, 2.5).to(8.5, 2.5), robot_at(4.5, 4.5)});
  const Plan plan = checked_plan(problem);
  ASSERT_EQ(plan.plans.size(), 3u);
  EXPECT_TRUE(plan.plans[0].actions.empty());
  EXPECT_EQ(plan.plans[0].cost, 0.0);
  EXPECT_GT(plan.plans[1].cost, 8.0);
  EXPECT_EQ(plan.objectives.flowtime, plan.plans[1].cost);
}

TEST(Planner, ReportsTheParkedRobotThatBlocksTheOnlyPath) {
  const Problem problem =
      support::make_problem(OccupancyGrid(9, 1, 1.0), {robot_at(4.5, 0.5), robot_at(0.5, 0.5).to(8.5, 0.5)});
  expect_unplanned(checked_plan(problem), 1, Reason::blocked_by_robots, {0});
}

TEST(Planner, ReturnsPlansAndUnplannedRobotsInTheOrderOfTheRobots) {
  const Problem problem = support::make_problem(
      support::ascii_map({".........",  //
                          ".........",  //
                          "########.",  //
                          "........."}),
      {robot_at(8.5, 3.5).to(0.5, 3.5), robot_at(0.6, 0.5).to(8.5, 2.5).radius(0.5), robot_at(0.5, 2.5)});
  PlanOptions options;
  options.inflation = 0.05;
  const Plan plan = checked_plan(problem, options);
  ASSERT_EQ(plan.plans.size(), 2u);
  EXPECT_EQ(plan.plans[0].robot, 0u);
  EXPECT_EQ(plan.plans[1].robot, 2u);
  expect_unplanned(plan, 1, Reason::start_blocked, {});
}

/// Large and small, slow and fast robots whose paths all cross.
Problem crossing_fleet() {
  return support::make_problem(
      OccupancyGrid(16, 16, 1.0),
      {robot_at(2, 8).to(14, 8, 0.0).radius(1.3).speeds(0.5, 0.3),
       robot_at(8, 2, kPi / 2).to(8, 14).radius(0.9), robot_at(8, 14).to(8, 2).radius(0.2).speeds(3.0, 6.0),
       robot_at(14, 8, 1.0).to(2, 8).radius(0.5).speeds(1.5, 2.0), robot_at(2, 2).to(14, 14, kPi).radius(0.7),
       robot_at(13.3, 13.9).to(2.2, 2.7).radius(0.35).speeds(2.0, 1.0), robot_at(8, 8).to(8, 8, 2.0)});
}

TEST(Planner, PlansCrossingRobotsOfMixedSizesAndSpeeds) {
  const Plan plan = checked_plan(crossing_fleet());
  EXPECT_TRUE(plan.unplanned.empty());
  EXPECT_TRUE(plan.deterministic);
}

TEST(Planner, ReturnsTheSamePlanForTheSameProblem) {
  for (const Mode mode : {Mode::first, Mode::anytime}) {
    PlanOptions options;
    options.mode = mode;
    options.max_iterations = 20;
    options.priority = PlanOptions::Priority::random;
    options.seed = 42;
    EXPECT_EQ(support::exact_text(checked_plan(crossing_fleet(), options)),
              support::exact_text(checked_plan(crossing_fleet(), options)));
  }
}

TEST(Planner, NeverMakesTheFirstPlanWorseInAnytimeMode) {
  PlanOptions options;
  const Plan first = checked_plan(crossing_fleet(), options);
  options.mode = Mode::anytime;
  options.max_iterations = 40;
  const Plan improved = checked_plan(crossing_fleet(), options);
  EXPECT_LE(improved.objectives.flowtime, first.objectives.flowtime);
  EXPECT_TRUE(improved.deterministic);
  const bool cheaper = improved.objectives.flowtime < first.objectives.flowtime;
  EXPECT_EQ(cheaper, improved.search.improvements > 0);
  options.objective = PlanOptions::Objective::makespan;
  EXPECT_LE(checked_plan(crossing_fleet(), options).objectives.makespan, first.objectives.makespan);
}

TEST(Planner, KeepsInflatedRobotsApartAndClearOfWalls) {
  PlanOptions options;
  options.inflation = 0.09;
  EXPECT_TRUE(checked_plan(swap_with_bay(), options).unplanned.empty()) << "0.49 m fit into the corridor";
  options.inflation = 0.11;
  const Plan plan = checked_plan(swap_with_bay(), options);
  expect_unplanned(plan, 0, Reason::start_blocked, {});
  expect_unplanned(plan, 1, Reason::start_blocked, {});
}

TEST(Planner, WaitsBeforeEveryMoveWithThatOption) {
  PlanOptions options;
  options.wait_before_move = 0.7;
  const Plan plan = checked_plan(swap_with_bay(), options);
  EXPECT_TRUE(plan.unplanned.empty());
  for (const RobotPlan& robot : plan.plans) {
    for (std::size_t i = 0; i < robot.actions.size(); ++i) {
      if (robot.actions[i].type != Action::Type::translate) continue;
      ASSERT_GT(i, 0u);
      EXPECT_EQ(robot.actions[i - 1].type, Action::Type::wait);
      EXPECT_GE(robot.actions[i - 1].t_end - robot.actions[i - 1].t_start, 0.7 - 1e-9);
    }
  }
}

TEST(Planner, PlansOnAFineMapWithRobotsOfSixCells) {
  // A room of 3 m x 2 m at 5 cm, divided by a wall with an opening of 40 cm. The robots are 30 cm wide.
  OccupancyGrid lab(60, 40, 0.05);
  for (int row = 0; row < 40; ++row) {
    if (row >= 16 && row < 24) continue;
    lab.block({29, row});
    lab.block({30, row});
  }
  const Problem problem = support::make_problem(
      std::move(lab), {robot_at(0.3, 0.3).to(2.7, 1.7).radius(0.15).speeds(0.5, 1.5),
                       robot_at(2.7, 1.7).to(0.3, 0.3).radius(0.15).speeds(0.5, 1.5),
                       robot_at(0.31, 1.62, 1.0).to(2.66, 0.41, -2.0).radius(0.15).speeds(0.5, 1.5)});
  const Plan plan = checked_plan(problem);
  EXPECT_TRUE(plan.unplanned.empty());
}

/// Three robots in a maze, where every search takes long.
Problem maze_fleet() {
  return support::make_problem(maze(), {robot_at(0.5, 0.5).to(27.5, 8.5), robot_at(27.5, 8.5).to(0.5, 0.5),
                                        robot_at(13.5, 7.5).to(13.5, 1.5)});
}

TEST(Planner, LeavesAllRobotsUnplannedWhenCancelledBeforeItStarts) {
  PlanOptions options;
  options.mode = Mode::anytime;  // runs until it is stopped
  const Plan plan = checked_plan(maze_fleet(), options, met());
  EXPECT_FALSE(plan.deterministic);
  EXPECT_TRUE(plan.plans.empty());
  for (std::size_t i = 0; i < 3; ++i) expect_unplanned(plan, i, Reason::budget_exhausted, {});
}

TEST(Planner, LeavesAllRobotsUnplannedAfterTheDeadline) {
  const StopCondition late(StopCondition::Clock::now() - std::chrono::seconds(1));
  const Plan plan = checked_plan(maze_fleet(), {}, late);
  EXPECT_FALSE(plan.deterministic);
  EXPECT_TRUE(plan.plans.empty());
  EXPECT_EQ(plan.objectives.flowtime, 0.0);
}

TEST(Planner, EndsWithoutADeadlineWhereNoRobotCanTranslate) {
  const Problem problem = support::make_problem(
      OccupancyGrid(5, 1, 1.0), {robot_at(0.5, 0.5).to(4.5, 0.5), robot_at(4.5, 0.5).to(0.5, 0.5),
                                 robot_at(2.5, 0.5).to(2.5, 0.5, kPi)});
  const Plan plan = checked_plan(problem);
  EXPECT_TRUE(plan.deterministic);
  EXPECT_GE(plan.plans.size(), 1u) << "robot 2 can rotate in place";
}

/// Met after a minute, which no test needs.
StopCondition in_a_minute() { return StopCondition(StopCondition::Clock::now() + std::chrono::minutes(1)); }

TEST(Planner, NamesTheRobotInTheOnlyDoorWithoutSearchingTheHall) {
  OccupancyGrid grid(300, 300, 1.0);
  for (int k = 0; k < 30; ++k) {
    grid.block({270, 270 + k});
    grid.block({270 + k, 270});
  }
  OccupancyGrid open(300, 300, 1.0);
  for (int row = 0; row < 300; ++row) {
    for (int column = 0; column < 300; ++column) {
      if (grid.blocked({column, row}) && !(column == 270 && row == 285)) open.block({column, row});
    }
  }
  const Problem problem =
      support::make_problem(open, {robot_at(10.5, 10.5).to(290.5, 290.5), robot_at(270.5, 285.5)});
  const Plan plan = checked_plan(problem, {}, in_a_minute());
  expect_unplanned(plan, 0, Reason::blocked_by_robots, {1});
  EXPECT_LT(plan.search.expansions, 10'000) << "the hall has 90,000 cells";
  EXPECT_TRUE(plan.deterministic);
  EXPECT_TRUE(plan.search.exhausted);
}

TEST(Planner, EndsAnytimeWhenNoRobotCanBecomeCheaper) {
  // The lattice makes the path around the wall longer than the bound.
  PlanOptions options;
  options.mode = Mode::anytime;
  const Problem problem = support::make_problem(support::ascii_map({"...........",  //
                                                                    "....###....",  //
                                                                    "....###....",  //
                                                                    "..........."}),
                                                {robot_at(3.2, 1.7).to(8.3, 1.9).radius(0.23)});
  const Plan plan = checked_plan(problem, options, in_a_minute());
  EXPECT_GT(plan.plans[0].cost, plan.plans[0].lower_bound + 1e-6);
  EXPECT_TRUE(plan.search.exhausted);
  EXPECT_TRUE(plan.deterministic);
}

/// Six large robots in a narrow hall, with a long wait before every move.
Problem crowded_hall(std::vector<MovingObstacle> obstacles = {}) {
  OccupancyGrid grid(108, 72, 0.05);
  const auto block = [&](int column, int row, int columns, int rows) {
    for (int c = column; c < column + columns; ++c) {
      for (int r = row; r < row + rows; ++r) grid.block({c, r});
    }
  };
  block(52, 14, 10, 18);
  block(26, 40, 16, 10);
  block(74, 46, 14, 8);
  std::vector<Robot> robots{robot_at(0.369, 0.901, -0.7693244442825105).to(0.858, 2.692),
                            robot_at(3.299, 2.106, -1.8603628879585699).to(2.913, 3.148),
                            robot_at(4.276, 0.949, -3.1172411769578803).to(3.927, 3.173),
                            robot_at(4.926, 1.932, -1.3972468845166666).to(0.992, 1.801),
                            robot_at(2.657, 2.832, 0.6167838510487322).to(1.783, 1.508),
                            robot_at(2.151, 1.174, 2.3980589333648634).to(2.664, 2.228)};
  for (Robot& robot : robots) {
    robot.radius = 0.35;
    robot.linear_speed = 0.1;
    robot.angular_speed = 0.4188790204786391;
  }
  return support::make_problem(grid, robots, {.obstacles = std::move(obstacles)});
}

/// Six robots are given up after 41 failures each.
constexpr int kAttemptsUntilAllAreGivenUp = 247;

PlanOptions options_of_crowded_hall() {
  PlanOptions options;
  options.wait_before_move = 5.0;
  options.seed = 31;
  return options;
}

TEST(Planner, PlansInStepsWhereFailuresHaveNoEnd) {
  const Plan plan = checked_plan(crowded_hall(), options_of_crowded_hall(),
                                 StopCondition(StopCondition::Clock::now() + std::chrono::minutes(20)));
  EXPECT_TRUE(plan.unplanned.empty());
  EXPECT_LT(plan.search.attempts, kAttemptsUntilAllAreGivenUp);
}

TEST(Planner, PlansInOtherOrdersWhatTheFirstOneGaveUp) {
  // Somebody appears where the first robot starts, before it has left in any plan in steps.
  MovingObstacle somebody;
  somebody.radius = 0.05;
  somebody.motion = {{120.0, {0.369, 0.901}}, {121.0, {0.369, 0.901}}};
  const Plan plan = checked_plan(crowded_hall({somebody}), options_of_crowded_hall(),
                                 StopCondition(StopCondition::Clock::now() + std::chrono::minutes(20)));
  EXPECT_TRUE(plan.unplanned.empty());
  EXPECT_GT(plan.search.attempts, kAttemptsUntilAllAreGivenUp);
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
