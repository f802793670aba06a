#include "core/plan/kept_plans.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/model/itinerary.h"
#include "core/plan/planner.h"
#include "tests/core/plan/fleets.h"
#include "tests/core/support/planning.h"
#include "tests/support/ascii_map.h"
#include "tests/support/expect_safe.h"

namespace fleetplan::core {
namespace TEST_FILE {

using support::make_problem;
using support::robot_at;
using testing::ElementsAre;
using testing::IsEmpty;

/// A hall of 10 m x 10 m.
OccupancyGrid hall() { return OccupancyGrid(10, 10, 1.0); }

std::vector<Action> straight(const Robot& robot, double departure) {
  const double distance = (robot.goal->position - robot.start.position).norm();
  std::vector<Action> actions;
  if (departure > 0.0) {
    actions.push_back({Action::Type::wait, 0.0, departure, robot.start, robot.start});
  }
  actions.push_back({Action::Type::translate,
                     departure,
                     departure + distance / robot.linear_speed,
                     robot.start,
                     {robot.goal->position, robot.start.theta}});
  return actions;
}

/// The robot drives straight ahead to its goal, which lies in its direction.
Robot driving(Robot robot, double departure = 0.0) {
  robot.previous = straight(robot, departure);
  return robot;
}

/// Two robots that cross in the middle of the hall; the second one is later.
std::vector<Robot> crossing(double later) {
  return {driving(robot_at(1.5, 5.5).to(8.5, 5.5)),
          driving(robot_at(5.5, 1.5, M_PI / 2).to(5.5, 8.5), later)};
}

TEST(KeptPlans, AreNoneWithoutPreviousPlans) {
  const Problem problem = make_problem(hall(), {robot_at(1.5, 1.5).to(1.5, 1.5)});
  EXPECT_THAT(keep_previous_plans(problem, {}, StopCondition::never()).kept, IsEmpty());
}

TEST(KeptPlans, AreAllIfTheyHoldTogether) {
  const KeptPlans previous =
      keep_previous_plans(make_problem(hall(), crossing(2.0)), {}, StopCondition::never());
  EXPECT_THAT(previous.kept, ElementsAre(true, true));
  EXPECT_FALSE(previous.cut_off);
}

TEST(KeptPlans, AreThoseOfHigherPriorityWherePlansConflict) {
  const Problem problem = make_problem(hall(), crossing(0.1));
  PlanOptions options;
  options.priority = PlanOptions::Priority::as_listed;
  EXPECT_THAT(keep_previous_plans(problem, options, StopCondition::never()).kept, ElementsAre(true, false));
  std::vector<Robot> robots = problem.robots();
  robots[0].start.position.x() = 0.5;  // a longer way
  robots[0].previous = straight(robots[0], 0.0);
  EXPECT_THAT(keep_previous_plans(make_problem(hall(), robots), {}, StopCondition::never()).kept,
              ElementsAre(false, true));
}

TEST(KeptPlans, HoldUnderTheInflationOfTheRequest) {
  const Problem problem = make_problem(hall(), crossing(1.3));
  PlanOptions options;
  EXPECT_THAT(keep_previous_plans(problem, options, StopCondition::never()).kept, ElementsAre(true, true));
  options.inflation = 0.1;
  EXPECT_THAT(keep_previous_plans(problem, options, StopCondition::never()).kept, ElementsAre(true, false));
}

/// The first robot is committed to pass the second one, which then drives where the first one has just been.
Problem passed_within_the_inflation() {
  const Robot passing = robot_at(1.0, 5.0).radius(0.2).speeds(1.0, 1.0).drives(3.5, 5.0);
  const double heading = std::atan2(-0.82, -0.5);
  Robot passed = robot_at(3.0, 5.42, heading).radius(0.2).speeds(1.0, 1.0).to(2.5, 4.6).waits(2.5);
  passed.previous = straight(passed, 2.5);
  return make_problem(hall(), {passing, passed});
}

TEST(KeptPlans, KeepTheMarginOfBareDisksWhereInflatedOnesOverlap) {
  const Problem problem = passed_within_the_inflation();
  PlanOptions options;
  options.inflation = 0.05;
  EXPECT_TRUE(keep_previous_plans(problem, options, StopCondition::never()).contains(1));
  options.interval_margin = 0.5;
  EXPECT_FALSE(keep_previous_plans(problem, options, StopCondition::never()).contains(1));
  const auto report = check_plan(problem, options, core::plan(problem, options, StopCondition::never()),
                                 StopCondition::never());
  ASSERT_TRUE(report);
  EXPECT_TRUE(report->valid());
}

TEST(KeptPlans, LeaveOutPlansThatEndElsewhere) {
  std::vector<Robot> robots = crossing(2.0);
  robots[0].goal->position.x() = 7.5;
  EXPECT_THAT(keep_previous_plans(make_problem(hall(), robots), {}, StopCondition::never()).kept,
              ElementsAre(false, true));
}

TEST(KeptPlans, LeaveOutPlansThroughParkedRobots) {
  std::vector<Robot> robots = crossing(2.0);
  robots.push_back(robot_at(7.5, 5.5));
  EXPECT_THAT(keep_previous_plans(make_problem(hall(), robots), {}, StopCondition::never()).kept,
              ElementsAre(false, true, false));
}

TEST(KeptPlans, LeaveOutPlansThroughWalls) {
  OccupancyGrid grid = hall();
  grid.block({7, 5});
  EXPECT_THAT(keep_previous_plans(make_problem(grid, crossing(2.0)), {}, StopCondition::never()).kept,
              ElementsAre(false, true));
}

TEST(KeptPlans, DoNotCareWhatARobotWithoutOneWillDo) {
  std::vector<Robot> robots = crossing(2.0);
  robots.push_back(robot_at(7.5, 5.5).to(7.5, 7.5));
  EXPECT_THAT(keep_previous_plans(make_problem(hall(), robots), {}, StopCondition::never()).kept,
              ElementsAre(true, true, false));
}

TEST(KeptPlans, IncludeARobotThatRestsAtItsGoal) {
  std::vector<Robot> robots = crossing(2.0);
  robots.push_back(robot_at(1.5, 1.5).to(1.5, 1.5));
  EXPECT_THAT(keep_previous_plans(make_problem(hall(), robots), {}, StopCondition::never()).kept,
              ElementsAre(true, true, true));
  robots.back().previous = std::vector<Action>{};
  EXPECT_THAT(keep_previous_plans(make_problem(hall(), robots), {}, StopCondition::never()).kept,
              ElementsAre(true, true, true));
}

TEST(KeptPlans, AreNoneIfTheCheckIsNotFinished) {
  const KeptPlans previous = keep_previous_plans(make_problem(hall(), crossing(2.0)), {}, met());
  EXPECT_THAT(previous.kept, ElementsAre(false, false));
  EXPECT_TRUE(previous.cut_off);
}

TEST(KeptPlans, AreSafeAmongRobotsThatStay) {
  std::vector<Robot> robots = crossing(2.0);
  robots.push_back(robot_at(7.5, 5.5).to(7.5, 7.5));
  robots.push_back(driving(robot_at(1.5, 8.5, -M_PI / 2).to(1.5, 1.5), 3.0));
  const Problem problem = make_problem(hall(), robots);
  // The first robot cannot pass the third one; the last one cannot pass the first one then.
  EXPECT_THAT(keep_previous_plans(problem, {}, StopCondition::never(), LeftOut::stay).kept,
              ElementsAre(false, true, false, false));
}

TEST(PlanWithoutSearch, PlansRobotsWithSafePreviousPlans) {
  std::vector<Robot> robots = crossing(2.0);
  robots.push_back(robot_at(7.5, 5.5).to(7.5, 7.5));
  const Problem problem = make_problem(hall(), robots);
  const Plan plan = plan_without_search(problem, {}, "No time.", StopCondition::never());
  support::expect_safe(problem, plan);
  ASSERT_EQ(plan.plans.size(), 1u);
  EXPECT_EQ(plan.plans[0].robot, 1u);
  EXPECT_EQ(plan.objectives.flowtime, 9.0);
  EXPECT_NEAR(plan.lower_bound.flowtime, 7.0, 1e-9);
  EXPECT_FALSE(plan.deterministic);
  ASSERT_EQ(plan.unplanned.size(), 2u);
  EXPECT_EQ(plan.unplanned[0].detail, "No time.");
}

TEST(PlanWithoutSearch, PlansParkedRobotsOnlyIfTheCheckIsNotFinished) {
  std::vector<Robot> robots = crossing(2.0);
  robots.push_back(robot_at(7.5, 2.5));
  const Plan plan = plan_without_search(make_problem(hall(), robots), {}, "No time.", met());
  ASSERT_EQ(plan.plans.size(), 1u);
  EXPECT_EQ(plan.plans[0].robot, 2u);
}

TEST(PlanWithoutSearch, NamesInvalidRobotsAndCollisionsThatNobodyCanAvoid) {
  Robot parked = robot_at(7.5, 2.5);
  Robot invalid = robot_at(2.5, 2.5);
  parked.id = "parked";
  invalid.id = "invalid";
  invalid.invalid = true;
  const MovingObstacle person{"person", 0.3, {{1.0, {7.5, 0.5}}, {5.0, {7.5, 4.5}}}};
  auto problem = Problem::create(hall(), {parked, invalid}, {{person}}, StopCondition::never());
  const Plan plan = plan_without_search(std::get<Problem>(problem), {}, "No time.", StopCondition::never());
  ASSERT_EQ(plan.unplanned.size(), 1u);
  EXPECT_EQ(plan.unplanned[0].reason, Unplanned::Reason::invalid);
  ASSERT_EQ(plan.unavoidable.size(), 1u);
  EXPECT_EQ(plan.unavoidable[0].robot, 0u);
  EXPECT_EQ(plan.unavoidable[0].obstacle, 0u);
}

TEST(PreviousPlan, HasTheMotionOfItsActions) {
  const Robot robot = crossing(2.0)[1];
  const Trajectory trajectory = previous_trajectory(robot);
  EXPECT_TRUE(trajectory.is_previous);
  ASSERT_EQ(trajectory.moves.size(), 1u);
  EXPECT_EQ(trajectory.moves[0].t_start, 2.0);
  EXPECT_EQ(trajectory.cost, 9.0);
  EXPECT_EQ(trajectory.end(), robot.goal->position);
}

TEST(PreviousPlan, VisitsEachGoal) {
  Robot robot = crossing(2.0)[1];
  robot.via = {{robot.start.position, std::nullopt, 1.5, 0.25}};
  const std::vector<Visit> visits = visits_of(robot, previous_actions(robot));
  ASSERT_EQ(visits.size(), 2u);
  EXPECT_EQ(visits[0].t_arrive, 0.0);
  EXPECT_EQ(visits[0].t_leave, 1.75);
  EXPECT_EQ(visits[1].goal, 1u);
  EXPECT_EQ(visits[1].t_arrive, 9.0);
  EXPECT_EQ(visits[1].t_leave, kForever);
  EXPECT_EQ(previous_trajectory(robot).visits.size(), 1u);
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
