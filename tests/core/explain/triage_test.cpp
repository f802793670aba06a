#include "core/explain/triage.h"

#include <gtest/gtest.h>

#include <cmath>
#include <ctime>
#include <numbers>
#include <string>

#include "tests/core/support/planning.h"

namespace fleetplan::core {
namespace TEST_FILE {

using support::robot_at;
constexpr double kPi = std::numbers::pi;
using Reason = Unplanned::Reason;
using Robots = std::vector<std::size_t>;

PlanOptions inflated(double metres) {
  PlanOptions options;
  options.inflation = metres;
  return options;
}

void expect_given_up(const std::optional<Unplanned>& robot, std::size_t index, Reason reason,
                     const Robots& blocked_by = {}) {
  ASSERT_TRUE(robot) << "robot " << index;
  EXPECT_EQ(robot->robot, index);
  EXPECT_EQ(static_cast<int>(robot->reason), static_cast<int>(reason)) << robot->detail;
  EXPECT_EQ(robot->blocked_by, blocked_by);
  EXPECT_FALSE(robot->detail.empty());
}

/// Two rooms, a doorway of a metre between them.
OccupancyGrid rooms() {
  return support::ascii_map({"....#....",  //
                             ".........",  //
                             "....#...."});
}

TEST(Triage, AcceptsRobotsThatCanBePlanned) {
  Planning p(rooms(), {robot_at(1, 1).to(8, 1), robot_at(8, 2).to(1, 2), robot_at(3, 1)});
  for (const auto& robot : triage(p.state, p.never)) EXPECT_FALSE(robot);
  EXPECT_EQ(p.reservations.robots_crossing_place(0), Robots{}) << "it has no reservation";
}

TEST(Triage, KeepsParkedRobotsAtTheirStarts) {
  Planning p(rooms(), {robot_at(1, 1).to(1, 2), robot_at(3, 1)});
  EXPECT_FALSE(triage(p.state, p.never)[1]);
  EXPECT_EQ(p.reservations.conflicting_robots(0, through({{1, 1}, {3.5, 1}})), Robots{1});
}

TEST(Triage, GivesUpARobotThatCannotLeaveItsStartWhenInflated) {
  // The niche at the left is as wide as the first robot; inflated, it fits nowhere near.
  Planning p(support::ascii_map({"##########",  //
                                 "......####",  //
                                 "#####.....",  //
                                 "#####....."}),
             {robot_at(0.5, 2.5).to(6, 1), robot_at(8, 1).to(7.5, 1)}, inflated(0.2));
  const auto result = triage(p.state, p.never);
  expect_given_up(result[0], 0, Reason::start_blocked);
  EXPECT_FALSE(result[1]);
  EXPECT_EQ(p.reservations.conflicting_robots(1, through({{6, 1}, {1.5, 2.5}})), Robots{0})
      << "it stays at its start";
}

TEST(Triage, AcceptsARobotThatCanLeaveAWallThatIsTooNearWhenInflated) {
  Planning p(rooms(), {robot_at(0.45, 1).to(3, 1)}, inflated(0.1));
  EXPECT_FALSE(triage(p.state, p.never)[0]);
}

TEST(Triage, AcceptsRobotsThatOverlapAtTheirStartsWhenInflated) {
  Planning p(rooms(), {robot_at(1, 1).to(3, 1), robot_at(1.9, 1), robot_at(6, 1).to(8, 1)}, inflated(0.06));
  for (const auto& robot : triage(p.state, p.never)) EXPECT_FALSE(robot);
}

TEST(Triage, GivesUpARobotThatOverlapsTooManyOthersAtItsStartWhenInflated) {
  std::vector<Robot> robots{robot_at(4.5, 1.5).radius(0.4).to(8, 1)};
  for (int k = 0; k < 66; ++k) {
    const double angle = k * 2.0 * kPi / 66.0;
    robots.push_back(robot_at(4.5 + 0.45 * std::cos(angle), 1.5 + 0.45 * std::sin(angle)).radius(0.01));
  }
  Planning p(OccupancyGrid(9, 3, 1.0), robots, inflated(0.1));
  const auto result = triage(p.state, p.never);
  ASSERT_TRUE(result[0]);
  EXPECT_EQ(result[0]->reason, Reason::start_blocked);
  EXPECT_EQ(result[0]->blocked_by.total(), 66u);
  EXPECT_FALSE(result[1]);
}

TEST(Triage, GivesUpARobotWhoseWayTakesLongerThanAPlanMay) {
  Planning p(OccupancyGrid(10, 1, 1e5), {robot_at(5e4, 5e4).to(9.5e5, 5e4).speeds(5e-3, 1.0),
                                         robot_at(1.5e5, 5e4).to(8.5e5, 5e4).speeds(2e-2, 1.0)});
  const auto result = triage(p.state, p.never);
  expect_given_up(result[0], 0, Reason::goal_unreachable);
  EXPECT_FALSE(result[1]);
}

TEST(Triage, GivesUpARobotThatIsTooWideAtItsGoalWhenInflated) {
  Planning p(rooms(), {robot_at(3, 1).to(0.45, 1)}, inflated(0.06));
  expect_given_up(triage(p.state, p.never)[0], 0, Reason::goal_blocked);
}

TEST(Triage, PlansTheFirstOfTwoRobotsWhoseInflatedGoalsOverlap) {
  Planning p(rooms(), {robot_at(1, 1).to(6, 1), robot_at(1, 2).to(6.9, 1), robot_at(3, 2).to(8, 1)},
             inflated(0.06));
  const auto result = triage(p.state, p.never);
  EXPECT_FALSE(result[0]);
  expect_given_up(result[1], 1, Reason::goal_blocked, {0});
  EXPECT_FALSE(result[2]);
}

TEST(Triage, AcceptsContactWhenInflated) {
  Planning p(rooms(), {robot_at(0.5, 0.5).to(0.5, 2.5), robot_at(1.5, 0.5).to(1.5, 2.5)}, inflated(0.1));
  for (const auto& robot : triage(p.state, p.never)) EXPECT_FALSE(robot);
}

TEST(Triage, GivesUpARobotForWhichNoPathIsWideEnough) {
  Planning p(rooms(), {robot_at(1, 1).to(8, 1).radius(0.6), robot_at(1, 2.4).to(8, 2.4)});
  const auto result = triage(p.state, p.never);
  expect_given_up(result[0], 0, Reason::goal_unreachable);
  EXPECT_FALSE(result[1]);
}

TEST(Triage, GivesUpARobotWhoseGoalIsOccupiedByAParkedRobot) {
  Planning p(rooms(), {robot_at(1, 1).to(6, 1), robot_at(6.5, 1), robot_at(6, 2.5).to(8, 2)});
  const auto result = triage(p.state, p.never);
  expect_given_up(result[0], 0, Reason::goal_blocked, {1});
  EXPECT_FALSE(result[2]);
}

TEST(Triage, GivesUpRobotsWhoseGoalsAreOccupiedByRobotsGivenUp) {
  // The goal of 2 is the start of 1, whose goal is the start of 0, which cannot leave its room.
  Planning p(rooms(), {robot_at(1, 1).to(8, 2).radius(0.6), robot_at(6, 1).to(1, 1),
                       robot_at(8, 0.5).to(6, 1), robot_at(3.3, 2).to(8, 0.5)});
  const auto result = triage(p.state, p.never);
  expect_given_up(result[0], 0, Reason::goal_unreachable);
  expect_given_up(result[1], 1, Reason::goal_blocked, {0});
  expect_given_up(result[2], 2, Reason::goal_blocked, {1});
  expect_given_up(result[3], 3, Reason::goal_blocked, {2});
}

TEST(Triage, DoesNotReportAGoalAsUnreachableWhenStopped) {
  Planning p(support::ascii_map({"..............#.",  //
                                 "..............#.",  //
                                 "..............#."}),
             {robot_at(0.5, 0.5).to(15.5, 0.5).radius(0.2)});
  EXPECT_TRUE(triage(p.state, p.never)[0]);
  // From the goal only three places are reachable, so the search ends at once; in reverse it does not.
  Planning reversed(support::ascii_map({"..............#.",  //
                                        "..............#.",  //
                                        "..............#.",  //
                                        "..............#.",  //
                                        "..............#.",  //
                                        "..............#."}),
                    {robot_at(15.5, 0.5).to(0.5, 0.5).radius(0.2)});
  EXPECT_FALSE(triage(reversed.state, met())[0]);
}

TEST(Triage, FollowsALongChainOfOccupiedGoalsInLittleTime) {
  // The goal of each robot is the start of the next one; the last one is parked.
  constexpr int kRobots = 2000;
  const auto place = [](int k) { return Position(2 * (k % 50) + 0.5, 2 * (k / 50) + 0.5); };
  std::vector<Robot> robots;
  for (int k = 0; k < kRobots; ++k) {
    robots.push_back(robot_at(place(k).x(), place(k).y()));
    if (k + 1 < kRobots) robots.back().goal = Goal{place(k + 1), std::nullopt};
  }
  Planning p(OccupancyGrid(100, 80, 1.0), robots);
  const std::clock_t before = std::clock();
  const auto result = triage(p.state, p.never);
  EXPECT_LT(static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC, 3.0) << "cubic time takes 13 s";
  for (std::size_t k = 0; k + 1 < kRobots; ++k) expect_given_up(result[k], k, Reason::goal_blocked, {k + 1});
}

/// A gate of 1 m between cells of half a metre: no centre of a cell in it is far enough from its sides.
OccupancyGrid gate_between_cells() {
  OccupancyGrid grid(21, 10, 0.5);
  for (int row = 0; row < 10; ++row) {
    if (row != 4 && row != 5) grid.block({10, row});
  }
  return grid;
}

TEST(Triage, FindsAWayBetweenTheCellsOfTheLattice) {
  Planning p(gate_between_cells(), {robot_at(1.25, 1.25).to(9.25, 4.25).radius(0.3)});
  EXPECT_FALSE(triage(p.state, p.never)[0]);
}

TEST(Triage, SaysThatOnlyTheLatticeHasNoWay) {
  Planning p(gate_between_cells(), {robot_at(1.25, 1.25).to(9.25, 4.25).radius(0.49)});
  const auto result = triage(p.state, p.never);
  expect_given_up(result[0], 0, Reason::goal_unreachable);
  EXPECT_NE(result[0]->detail.find("lattice"), std::string::npos) << result[0]->detail;
  EXPECT_NE(result[0]->detail.find("1.00 m"), std::string::npos) << result[0]->detail;
}

TEST(Triage, LeavesTheMapSearchesOfMostRobotsForLater) {
  OccupancyGrid grid(300, 300, 1.0);
  for (int row = 0; row < 300; ++row) {
    if (row != 150) grid.block({150, row});
  }
  std::vector<Robot> robots;
  for (int k = 0; k < 60; ++k) robots.push_back(robot_at(10.5, 4 * k + 10.5).to(290.5, 280.5 - 4 * k));
  Planning p(grid, robots);
  triage(p.state, p.never);
  EXPECT_EQ(p.state.ways().way_to_goal(59).kind, Way::Kind::unknown);
  EXPECT_LE(p.state.ways().map_expansions(), 50'000);
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
