#include "core/prioritized/partial_plan.h"

#include <gtest/gtest.h>

#include "tests/core/support/planning.h"

namespace fleetplan::core {
namespace {

using support::expect_safe;
using support::robot_at;
using Reason = Unplanned::Reason;
using Robots = std::vector<std::size_t>;

/// A hall with a closet; whoever stands in the closet's entrance shuts it.
OccupancyGrid hall() {
  return support::ascii_map({".......",  //
                             ".......",  //
                             ".......",  //
                             "#####.#",  //
                             "#####.#"});
}

Robots robots_of(const PartialPlan& completion) {
  Robots robots;
  for (const Unplanned& robot : completion.unplanned) robots.push_back(robot.robot);
  return robots;
}

/// Robots may drive over each other's starts at once.
PlanOptions hasty() {
  PlanOptions options;
  options.start_safe_interval = 0.0;
  return options;
}

TEST(Complete, PlansEveryRobotThatHasNoTrajectoryYet) {
  Planning p(hall(), {robot_at(0.5, 3.5).to(6.5, 3.5), robot_at(6.5, 2.5).to(0.5, 2.5)});
  p.state.follow(1, through({{6.5, 2.5}, {0.5, 2.5}}, 4.0));
  const PartialPlan completion = make_partial_plan(p.state, {1, 0}, {}, p.never, p.progress);
  EXPECT_TRUE(completion.unplanned.empty());
  EXPECT_FALSE(completion.cut_off);
  EXPECT_EQ(p.state.trajectory(1)->moves.front().t_start, 4.0) << "it was planned already";
  expect_safe(p.state);
}

TEST(Complete, GivesARobotUpAndNamesThoseInItsWay) {
  Planning p(hall(), {robot_at(3.5, 3.5).to(5.5, 0.5), robot_at(5.5, 1.5), robot_at(0.5, 4.5).to(6.5, 4.5)});
  p.state.stand_for_ever(1);
  const PartialPlan completion = make_partial_plan(p.state, {0, 2}, {}, p.never, p.progress);
  ASSERT_EQ(robots_of(completion), Robots{0});
  EXPECT_EQ(static_cast<int>(completion.unplanned[0].reason), static_cast<int>(Reason::blocked_by_robots));
  EXPECT_EQ(completion.unplanned[0].blocked_by, Robots{1});
  EXPECT_FALSE(completion.cut_off);
  EXPECT_TRUE(p.state.trajectory(2)) << "its neighbour is not taken down";
  expect_safe(p.state);
}

TEST(Complete, DoesNotNameRobotsThatCouldStay) {
  // Robot 2 crosses the way of robot 0 to the closet that robot 1 shuts.
  Planning p(hall(), {robot_at(3.5, 3.5).to(5.5, 0.5), robot_at(5.5, 1.5), robot_at(2.5, 2.5).to(6.5, 2.5)});
  p.state.stand_for_ever(1);
  p.state.follow(2, through({{2.5, 2.5}, {6.5, 2.5}}));
  ASSERT_EQ(p.state.conflicting_robots(0, p.state.alone(0, p.never)), (Robots{1, 2}));
  const PartialPlan completion = make_partial_plan(p.state, {0}, {}, p.never, p.progress);
  ASSERT_EQ(robots_of(completion), Robots{0});
  EXPECT_EQ(completion.unplanned[0].blocked_by, Robots{1});
  expect_safe(p.state);
}

TEST(Complete, PlansThoseAgainThatCrossedTheStartOfARobotGivenUp) {
  // Robot 0 drives straight over the start of 1, which then turns out to stay there.
  Planning p(hall(), {robot_at(0.5, 3.5).to(6.5, 3.5), robot_at(3.5, 3.5).to(5.5, 0.5), robot_at(5.5, 1.5)},
             hasty());
  p.state.stand_for_ever(2);
  p.state.follow(0, through({{0.5, 3.5}, {6.5, 3.5}}));
  const PartialPlan completion = make_partial_plan(p.state, {0, 1}, {}, p.never, p.progress);
  EXPECT_EQ(robots_of(completion), Robots{1});
  ASSERT_TRUE(p.state.trajectory(0));
  EXPECT_GT(p.state.trajectory(0)->cost, 6.0) << "round robot 1";
  expect_safe(p.state);
}

TEST(Complete, GivesThoseUpAsWellThatHaveNoOtherWay) {
  // In a corridor nobody gets round robot 1, which robot 2 keeps from its goal.
  Planning p(OccupancyGrid(9, 1, 1.0),
             {robot_at(0.5, 0.5).to(5.5, 0.5), robot_at(3.5, 0.5).to(8.5, 0.5), robot_at(7.5, 0.5)}, hasty());
  p.state.stand_for_ever(2);
  p.state.follow(0, through({{0.5, 0.5}, {5.5, 0.5}}));
  const PartialPlan completion = make_partial_plan(p.state, {0, 1}, {}, p.never, p.progress);
  ASSERT_EQ(robots_of(completion), (Robots{0, 1}));
  EXPECT_EQ(completion.unplanned[0].blocked_by, Robots{1});
  EXPECT_EQ(completion.unplanned[1].blocked_by, Robots{2});
  EXPECT_FALSE(p.state.trajectory(0));
  expect_safe(p.state);
}

TEST(Complete, TriesHopelessRobotsOnceMore) {
  Planning p(hall(), {robot_at(0.5, 3.5).to(6.5, 3.5), robot_at(3.5, 2.5).to(5.5, 0.5)});
  p.state.stand_for_ever(1);
  const PartialPlan completion = make_partial_plan(p.state, {0}, {1}, p.never, p.progress);
  EXPECT_TRUE(completion.unplanned.empty()) << "nobody is in its way any more";
  EXPECT_TRUE(p.state.trajectory(1));
  expect_safe(p.state);
}

TEST(Complete, PlansNobodyOnceItIsStopped) {
  Planning p(hall(), {robot_at(0.5, 3.5).to(6.5, 3.5), robot_at(3.5, 2.5).to(5.5, 0.5)});
  const PartialPlan completion = make_partial_plan(p.state, {0, 1}, {}, met(), p.progress);
  ASSERT_EQ(robots_of(completion), (Robots{0, 1}));
  EXPECT_EQ(static_cast<int>(completion.unplanned[0].reason), static_cast<int>(Reason::budget_exhausted));
  EXPECT_TRUE(completion.cut_off);
  expect_safe(p.state);
}

TEST(Complete, TakesPlansBackThatCrossARobotLeftUnplannedWhenStopped) {
  Planning p(
      hall(),
      {robot_at(0.5, 3.5).to(6.5, 3.5), robot_at(3.5, 3.5).to(5.5, 0.5), robot_at(0.5, 4.5).to(6.5, 4.5)},
      hasty());
  p.state.follow(0, through({{0.5, 3.5}, {6.5, 3.5}}));
  p.state.follow(2, through({{0.5, 4.5}, {6.5, 4.5}}));
  const PartialPlan completion = make_partial_plan(p.state, {0, 2, 1}, {}, met(), p.progress);
  EXPECT_EQ(robots_of(completion), (Robots{0, 1})) << "2 crosses nobody";
  EXPECT_TRUE(p.state.trajectory(2));
  expect_safe(p.state);
}

}  // namespace
}  // namespace fleetplan::core
