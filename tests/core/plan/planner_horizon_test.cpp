// What plans say of the time beyond the horizon, and of robots that gain nothing until then.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/model/plan.h"
#include "core/plan/planner.h"
#include "tests/support/ascii_map.h"
#include "tests/support/problem_builder.h"

namespace fleetplan::core {
namespace TEST_FILE {

using support::robot_at;
using Robots = std::vector<std::size_t>;

PlanOptions up_to(double horizon) {
  PlanOptions options;
  options.horizon = horizon;
  return options;
}

OccupancyGrid corridor() { return support::ascii_map({"...................."}); }
OccupancyGrid hall() {
  return support::ascii_map({"....................", "....................", "...................."});
}

Plan plan_of(OccupancyGrid grid, std::vector<Robot> robots, const PlanOptions& options) {
  const Problem problem = support::make_problem(std::move(grid), std::move(robots));
  Plan plan = core::plan(problem, options, StopCondition::never());
  EXPECT_TRUE(plan.unplanned.empty());
  EXPECT_TRUE(plan.deterministic);
  return plan;
}

Robots blocking(const RobotPlan& plan) { return {plan.blocked_by.begin(), plan.blocked_by.end()}; }

/// A robot that visits these places on its way to the last one.
Robot visitor(Robot robot, std::vector<Goal> via) {
  robot.via = std::move(via);
  return robot;
}

Goal goal_at(double x, double y, double service = 0.0, double not_before = 0.0) {
  return {Position(x, y), std::nullopt, service, not_before};
}

/// A hall in which the way to the right leads around a long wall, so that it takes many expansions to find. A
/// dead end of one cell is at the lower right.
OccupancyGrid hall_with_dead_end() {
  constexpr int kSide = 220;
  constexpr int kWall = 110;
  std::vector<std::string> rows(kSide, std::string(kSide, '.'));
  for (std::size_t row = 5; row < rows.size(); ++row) rows[row][kWall] = '#';
  for (const std::size_t row : {kSide - 7, kSide - 5}) {
    std::fill(rows[row].begin() + 200, rows[row].end(), '#');
  }
  return support::ascii_map(rows);
}

TEST(PlannerHorizon, LetsARobotComeNearerToAGoalThatOthersCloseOff) {
  const Plan plan =
      plan_of(hall_with_dead_end(), {robot_at(5.5, 5.5).to(215.5, 5.5), robot_at(203.5, 5.5)}, up_to(20.0));
  EXPECT_GT(plan.plans.at(0).actions.size(), 0U);
}

TEST(PlannerHorizon, EstimatesWhenRobotsComeToTheGoalsBeyondIt) {
  const Robot robot =
      visitor(robot_at(0.5, 0.5).to(18.5, 0.5), {goal_at(2.5, 0.5, 1.0), goal_at(15.5, 0.5, 2.0)});
  const Plan plan = plan_of(corridor(), {robot}, up_to(6.0));
  const RobotPlan& only = plan.plans.at(0);
  ASSERT_EQ(only.visits.size(), 1U);
  ASSERT_EQ(only.estimated_visits.size(), 2U);
  EXPECT_EQ(only.estimated_visits[0].goal, 1U);
  EXPECT_NEAR(only.estimated_visits[0].t_arrive, 16.0, 1e-9);
  EXPECT_NEAR(only.estimated_visits[0].t_leave, 18.0, 1e-9);
  EXPECT_EQ(only.estimated_visits[1].goal, 2U);
  EXPECT_NEAR(only.estimated_visits[1].t_arrive, 21.0, 1e-9);
  EXPECT_NEAR(*only.estimated_cost, 21.0, 1e-9);
  EXPECT_FALSE(only.is_stuck);
}

TEST(PlannerHorizon, EstimatesIncludeWaitsForNotBefore) {
  const Robot robot = visitor(robot_at(0.5, 0.5).to(18.5, 0.5), {goal_at(15.5, 0.5, 2.0, 40.0)});
  const Plan plan = plan_of(corridor(), {robot}, up_to(6.0));
  const RobotPlan& only = plan.plans.at(0);
  ASSERT_EQ(only.estimated_visits.size(), 2U);
  EXPECT_LT(only.estimated_visits[0].t_arrive, 22.0);
  EXPECT_NEAR(only.estimated_visits[0].t_leave, 42.0, 1e-9);
  EXPECT_NEAR(only.estimated_visits[1].t_arrive, 45.0, 1e-9);
  EXPECT_NEAR(*only.estimated_cost, 45.0, 1e-9);
  EXPECT_FALSE(only.is_stuck);
}

TEST(PlannerHorizon, AServiceAtTheLastGoalThatDoesNotBeginIsAnEstimate) {
  Robot robot = robot_at(0.5, 0.5).to(0.5, 0.5);
  Goal turned = goal_at(0.5, 0.5);
  turned.theta = std::numbers::pi;  // it turns for two seconds
  robot.via = {turned, goal_at(0.5, 0.5)};
  robot.goal->service = 2.0;
  const Plan plan = plan_of(corridor(), {robot}, up_to(1.0));
  const RobotPlan& only = plan.plans.at(0);
  EXPECT_NEAR(only.cost, 2.0, 1e-9) << "beyond the horizon";
  ASSERT_EQ(only.visits.size(), 2U);
  ASSERT_EQ(only.estimated_visits.size(), 1U);
  EXPECT_NEAR(only.estimated_visits[0].t_arrive, 2.0, 1e-9);
  EXPECT_NEAR(only.estimated_visits[0].t_leave, 4.0, 1e-9);
}

TEST(PlannerHorizon, HasNoEstimatesForPlansThatReachTheirGoals) {
  const Plan plan =
      plan_of(corridor(), {robot_at(0.5, 0.5).to(4.5, 0.5), robot_at(9.5, 0.5).to(9.5, 0.5)}, up_to(6.0));
  for (const RobotPlan& robot : plan.plans) {
    EXPECT_FALSE(robot.estimated_cost);
    EXPECT_TRUE(robot.estimated_visits.empty());
    EXPECT_FALSE(robot.is_stuck);
  }
}

TEST(PlannerHorizon, ARobotWhoseWayIsClosedByOneThatStaysIsStuckWithoutEstimates) {
  const Plan plan = plan_of(corridor(),
                            {visitor(robot_at(2.5, 0.5).to(18.5, 0.5), {goal_at(16.5, 0.5)}),
                             robot_at(3.5, 0.5), robot_at(10.5, 0.5).to(10.5, 0.5)},
                            up_to(10.0));
  const RobotPlan& first = plan.plans.at(0);
  EXPECT_TRUE(first.is_stuck);
  EXPECT_EQ(blocking(first), Robots{1});
  EXPECT_EQ(first.estimated_cost, kForever);
  ASSERT_EQ(first.estimated_visits.size(), 2U);
  EXPECT_EQ(first.estimated_visits[0].t_arrive, kForever);
  EXPECT_EQ(plan.estimated->flowtime, 0.0) << "of the robots that have estimates";
  EXPECT_FALSE(plan.plans.at(1).is_stuck);
  EXPECT_FALSE(plan.plans.at(2).is_stuck);
}

TEST(PlannerHorizon, ARobotWhoseGoalIsTakenIsStuckWithEstimates) {
  const Robot robot = visitor(robot_at(8.5, 0.5).to(18.5, 0.5), {goal_at(9.5, 0.5)});
  for (const auto mode : {PlanOptions::Mode::first, PlanOptions::Mode::anytime}) {
    PlanOptions options = up_to(10.0);
    options.mode = mode;
    options.max_iterations = 5;
    const Plan plan = plan_of(hall(), {robot, robot_at(9.5, 0.5), robot_at(4.5, 2.5)}, options);
    const RobotPlan& first = plan.plans.at(0);
    EXPECT_TRUE(first.is_stuck);
    EXPECT_EQ(blocking(first), Robots{1});
    EXPECT_NEAR(*first.estimated_cost, 20.0, 1e-9);
    EXPECT_NEAR(plan.estimated->flowtime, 20.0, 1e-9);
  }
}

TEST(PlannerHorizon, ARobotInAQueueIsStuckBehindTheOneBeforeIt) {
  const Plan plan = plan_of(
      corridor(), {robot_at(3.5, 0.5).to(17.5, 0.5), robot_at(2.5, 0.5).to(15.5, 0.5), robot_at(4.5, 0.5)},
      up_to(10.0));
  EXPECT_EQ(blocking(plan.plans.at(0)), Robots{2});
  EXPECT_TRUE(plan.plans.at(1).is_stuck);
  EXPECT_EQ(blocking(plan.plans.at(1)), Robots{2}) << "which closes its way; the other one may leave";
}

TEST(PlannerHorizon, ARobotThatIsServedIsNotStuck) {
  const Robot robot = visitor(robot_at(2.5, 0.5).to(18.5, 0.5), {goal_at(2.5, 0.5, 100.0)});
  const Plan plan = plan_of(corridor(), {robot, robot_at(3.5, 0.5)}, up_to(10.0));
  EXPECT_FALSE(plan.plans.at(0).is_stuck);
  EXPECT_EQ(plan.plans.at(0).visits.size(), 1U);
}

TEST(PlannerHorizon, ARobotThatWaitsForNotBeforeIsNotStuck) {
  const Robot waiting = visitor(robot_at(2.5, 0.5).to(18.5, 0.5), {goal_at(10.5, 0.5, 1.0, 100.0)});
  const Plan plan = plan_of(corridor(), {waiting, robot_at(3.5, 0.5)}, up_to(10.0));
  EXPECT_FALSE(plan.plans.at(0).is_stuck);
  const Robot late = visitor(robot_at(2.5, 0.5).to(18.5, 0.5), {goal_at(10.5, 0.5, 1.0, 5.0)});
  EXPECT_TRUE(plan_of(corridor(), {late, robot_at(3.5, 0.5)}, up_to(10.0)).plans.at(0).is_stuck);
}

TEST(PlannerHorizon, ARobotWhoseCommitmentMovesItOrHoldsItUntilTheHorizonIsNotStuck) {
  const Plan moved = plan_of(
      corridor(), {robot_at(0.5, 0.5).to(18.5, 0.5).drives(2.5, 0.5), robot_at(3.5, 0.5)}, up_to(10.0));
  EXPECT_FALSE(moved.plans.at(0).is_stuck);
  const Plan held =
      plan_of(corridor(), {robot_at(2.5, 0.5).to(18.5, 0.5).waits(12.0), robot_at(3.5, 0.5)}, up_to(10.0));
  EXPECT_FALSE(held.plans.at(0).is_stuck);
  const Plan waited =
      plan_of(corridor(), {robot_at(2.5, 0.5).to(18.5, 0.5).waits(1.0), robot_at(3.5, 0.5)}, up_to(10.0));
  EXPECT_TRUE(waited.plans.at(0).is_stuck);
}

TEST(PlannerHorizon, ARobotThatHasArrivedAndMakesWayIsNotStuck) {
  const Plan plan = plan_of(support::ascii_map({"##.###", "......"}),
                            {robot_at(2.5, 0.5).to(2.5, 0.5), robot_at(0.5, 0.5).to(5.5, 0.5)}, up_to(3.0));
  for (const RobotPlan& robot : plan.plans) EXPECT_FALSE(robot.is_stuck) << robot.robot;
}

TEST(PlannerHorizon, SaysNothingOfItWithoutAHorizon) {
  const Problem problem = support::make_problem(corridor(), {robot_at(2.5, 0.5).to(18.5, 0.5)});
  const Plan plan = core::plan(problem, {}, StopCondition::never());
  EXPECT_FALSE(plan.estimated);
  EXPECT_FALSE(plan.plans.at(0).estimated_cost);
  EXPECT_TRUE(plan.plans.at(0).estimated_visits.empty());
}

/// A robot that cannot make way rests in the short passage between two halls; the long one leads around it.
TEST(PlannerHorizon, TheOldestGoalIsServedOnAnotherWayIfNobodyCanMakeWay) {
  const OccupancyGrid grid = support::ascii_map({
      ".....#.....",
      ".###.#.###.",
      ".#.......#.",
      ".#######.#.",
      "...........",
  });
  std::vector<Robot> robots{robot_at(4.5, 4.5).to(6.5, 4.5), robot_at(5.5, 2.5).to(5.5, 2.5)};
  robots[1].linear_speed = 1e-3;
  const Plan waits = plan_of(grid, robots, up_to(5.0));
  EXPECT_TRUE(waits.plans[0].estimated_cost.has_value());
  robots[0].goal_age = 1.0;
  const Plan goes_around = plan_of(grid, robots, up_to(5.0));
  EXPECT_FALSE(goes_around.plans[0].estimated_cost.has_value());
  EXPECT_EQ(goes_around.plans[0].actions.back().to.position, Position(6.5, 4.5));
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
