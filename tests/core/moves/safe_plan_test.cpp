#include "core/moves/safe_plan.h"

#include <gtest/gtest.h>

#include "tests/core/support/planning.h"

namespace fleetplan::core {
namespace TEST_FILE {

using support::expect_safe;
using support::robot_at;
using Reason = Unplanned::Reason;
using Robots = std::vector<std::size_t>;

/// A hall with a closet; a robot in the closet's entrance blocks it.
OccupancyGrid hall() {
  return support::ascii_map({".......",  //
                             ".......",  //
                             ".......",  //
                             "#####.#",  //
                             "#####.#"});
}

/// Makes the plan in `state` safe, with full effort, and explains the robots that stay.
PartialPlan make_partial_plan(PlanState& state, const Robots& unsolved, const Robots& given_up,
                              const StopCondition& stop, ProgressReport& progress) {
  return explain(state, make_safe(state, unsolved, given_up, Effort::full, stop, progress), stop);
}

Robots robots_of(const PartialPlan& partial) {
  Robots robots;
  for (const Unplanned& robot : partial.unplanned) robots.push_back(robot.robot);
  return robots;
}

/// Robots may drive over each other's starts at once.
PlanOptions no_start_interval() {
  PlanOptions options;
  options.start_safe_interval = 0.0;
  return options;
}

TEST(PartialPlan, PlansRobotsWithoutATrajectory) {
  Planning p(hall(), {robot_at(0.5, 3.5).to(6.5, 3.5), robot_at(6.5, 2.5).to(0.5, 2.5)});
  p.reservations.follow(1, through({{6.5, 2.5}, {0.5, 2.5}}, 4.0));
  const PartialPlan partial = make_partial_plan(p.state, {1, 0}, {}, p.never, p.progress);
  EXPECT_TRUE(partial.unplanned.empty());
  EXPECT_FALSE(partial.cut_off);
  EXPECT_EQ(p.reservations.trajectory(1)->moves.front().t_start, 4.0) << "it was planned already";
  expect_safe(p.reservations);
}

TEST(PartialPlan, ReportsTheRobotsThatBlockAnUnplannedRobot) {
  Planning p(hall(), {robot_at(3.5, 3.5).to(5.5, 0.5), robot_at(5.5, 1.5), robot_at(0.5, 4.5).to(6.5, 4.5)});
  p.reservations.stay_in_place(1);
  const PartialPlan partial = make_partial_plan(p.state, {0, 2}, {}, p.never, p.progress);
  ASSERT_EQ(robots_of(partial), Robots{0});
  EXPECT_EQ(static_cast<int>(partial.unplanned[0].reason), static_cast<int>(Reason::blocked_by_robots));
  EXPECT_EQ(partial.unplanned[0].blocked_by, Robots{1});
  EXPECT_FALSE(partial.cut_off);
  EXPECT_TRUE(p.reservations.trajectory(2)) << "its neighbour keeps its plan";
  expect_safe(p.reservations);
}

TEST(PartialPlan, DoesNotReportRobotsThatDoNotBlock) {
  // Robot 2 crosses the path of robot 0 to the closet that robot 1 blocks.
  Planning p(hall(), {robot_at(3.5, 3.5).to(5.5, 0.5), robot_at(5.5, 1.5), robot_at(2.5, 2.5).to(6.5, 2.5)});
  p.reservations.stay_in_place(1);
  p.reservations.follow(2, through({{2.5, 2.5}, {6.5, 2.5}}));
  ASSERT_EQ(p.reservations.conflicting_robots(0, p.state.plan_alone(0, p.never)), (Robots{1, 2}));
  const PartialPlan partial = make_partial_plan(p.state, {0}, {}, p.never, p.progress);
  ASSERT_EQ(robots_of(partial), Robots{0});
  EXPECT_EQ(partial.unplanned[0].blocked_by, Robots{1});
  expect_safe(p.reservations);
}

TEST(PartialPlan, ReplansRobotsThatCrossedTheStartOfAnUnplannedRobot) {
  // Robot 0 drives straight over the start of robot 1, which is then found to stay there.
  Planning p(hall(), {robot_at(0.5, 3.5).to(6.5, 3.5), robot_at(3.5, 3.5).to(5.5, 0.5), robot_at(5.5, 1.5)},
             no_start_interval());
  p.reservations.stay_in_place(2);
  p.reservations.follow(0, through({{0.5, 3.5}, {6.5, 3.5}}));
  const PartialPlan partial = make_partial_plan(p.state, {0, 1}, {}, p.never, p.progress);
  EXPECT_EQ(robots_of(partial), Robots{1});
  ASSERT_TRUE(p.reservations.trajectory(0));
  EXPECT_GT(p.reservations.trajectory(0)->cost, 6.0) << "around robot 1";
  expect_safe(p.reservations);
}

TEST(PartialPlan, GivesUpRobotsWithoutAPathAroundAnUnplannedRobot) {
  // No robot can pass robot 1 in the corridor, and robot 2 blocks the goal of robot 1.
  Planning p(OccupancyGrid(9, 1, 1.0),
             {robot_at(0.5, 0.5).to(5.5, 0.5), robot_at(3.5, 0.5).to(8.5, 0.5), robot_at(7.5, 0.5)},
             no_start_interval());
  p.reservations.stay_in_place(2);
  p.reservations.follow(0, through({{0.5, 0.5}, {5.5, 0.5}}));
  const PartialPlan partial = make_partial_plan(p.state, {0, 1}, {}, p.never, p.progress);
  ASSERT_EQ(robots_of(partial), (Robots{0, 1}));
  EXPECT_EQ(partial.unplanned[0].blocked_by, Robots{1});
  EXPECT_EQ(partial.unplanned[1].blocked_by, Robots{2});
  EXPECT_FALSE(p.reservations.trajectory(0));
  expect_safe(p.reservations);
}

TEST(PartialPlan, TriesRobotsGivenUpOnceMore) {
  Planning p(hall(), {robot_at(0.5, 3.5).to(6.5, 3.5), robot_at(3.5, 2.5).to(5.5, 0.5)});
  p.reservations.stay_in_place(1);
  const PartialPlan partial = make_partial_plan(p.state, {0}, {1}, p.never, p.progress);
  EXPECT_TRUE(partial.unplanned.empty()) << "no robot blocks it any more";
  EXPECT_TRUE(p.reservations.trajectory(1));
  expect_safe(p.reservations);
}

TEST(PartialPlan, PlansNoRobotAfterStop) {
  Planning p(hall(), {robot_at(0.5, 3.5).to(6.5, 3.5), robot_at(3.5, 2.5).to(5.5, 0.5)});
  const PartialPlan partial = make_partial_plan(p.state, {0, 1}, {}, met(), p.progress);
  ASSERT_EQ(robots_of(partial), (Robots{0, 1}));
  EXPECT_EQ(static_cast<int>(partial.unplanned[0].reason), static_cast<int>(Reason::budget_exhausted));
  EXPECT_TRUE(partial.cut_off);
  expect_safe(p.reservations);
}

TEST(PartialPlan, RemovesPlansThatCrossAnUnplannedRobotWhenStopped) {
  Planning p(
      hall(),
      {robot_at(0.5, 3.5).to(6.5, 3.5), robot_at(3.5, 3.5).to(5.5, 0.5), robot_at(0.5, 4.5).to(6.5, 4.5)},
      no_start_interval());
  p.reservations.follow(0, through({{0.5, 3.5}, {6.5, 3.5}}));
  p.reservations.follow(2, through({{0.5, 4.5}, {6.5, 4.5}}));
  const PartialPlan partial = make_partial_plan(p.state, {0, 2, 1}, {}, met(), p.progress);
  EXPECT_EQ(robots_of(partial), (Robots{0, 1})) << "robot 2 conflicts with no robot";
  EXPECT_TRUE(p.reservations.trajectory(2));
  expect_safe(p.reservations);
}

TEST(PartialPlan, ReturnsRobotsToTheirPathsWhenTheOneInTheirWayHasLeft) {
  // The corridor has no way around robot 0.
  Planning p(support::ascii_map({"###.###",  //
                                 "......."}),
             {robot_at(3.5, 0.5).to(3.5, 1.5), robot_at(0.5, 0.5).to(6.5, 0.5)});
  p.reservations.follow(1, through({{0.5, 0.5}, {6.5, 0.5}}, 50.0));
  const PartialPlan partial = make_partial_plan(p.state, {0}, {}, p.never, p.progress);
  EXPECT_TRUE(partial.unplanned.empty());
  ASSERT_TRUE(p.reservations.trajectory(1));
  EXPECT_EQ(p.reservations.trajectory(1)->moves.front().t_start, 50.0) << "its earlier path, not a new one";
  expect_safe(p.reservations);
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
