// The search for one robot among others that move, wait or are parked.

#include "core/sipp/aa_sipp.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/core/support/planning.h"

namespace fleetplan::core {
namespace TEST_FILE {

using support::expect_safe;
using support::robot_at;

constexpr double kPi = std::numbers::pi;
/// Seconds: the search keeps distances to within half of the contact tolerance.
constexpr double kTime = 1e-8;

/// Plans robot 0 exactly among the others' reservations, reserves the result and checks that all are safe.
Trajectory plan_first(Planning& p) {
  const SearchResult result = p.state.plan(0, kExact, p.never);
  EXPECT_TRUE(result.complete);
  EXPECT_TRUE(result.trajectory);
  if (!result.trajectory) return {};
  p.reservations.follow(0, *result.trajectory);
  expect_safe(p.reservations);
  return *result.trajectory;
}

OccupancyGrid crossing() {
  return support::ascii_map({"####.####",  //
                             "####.####",  //
                             ".........",  //
                             "####.####",  //
                             "####.####"});
}

TEST(AaSipp, GoesStraightToGoalWithoutObstacles) {
  Planning p(OccupancyGrid(10, 10, 1.0), {robot_at(1.5, 1.5).to(4.5, 5.5, kPi / 2)});
  const Trajectory trajectory = plan_first(p);
  ASSERT_EQ(trajectory.moves.size(), 1u);
  EXPECT_NEAR(trajectory.cost, 5.0 + 1.0, 1e-12)
      << "5 m, and a quarter turn in total, which takes one second";
}

TEST(AaSipp, StaysAtStartForStartDelay) {
  Planning p(OccupancyGrid(10, 10, 1.0), {robot_at(1.5, 1.5).to(6.5, 1.5)});
  const SearchResult result = p.state.plan(0, {.start_delay = 2.5}, p.never);
  ASSERT_TRUE(result.trajectory);
  EXPECT_NEAR(result.trajectory->cost, 2.5 + 5.0, 1e-12);
}

TEST(AaSipp, IgnoresStartDelayIfGoalIsStart) {
  for (const bool turns : {false, true}) {
    const auto robot = turns ? robot_at(1.5, 1.5).to(1.5, 1.5, kPi / 2) : robot_at(1.5, 1.5).to(1.5, 1.5);
    Planning p(OccupancyGrid(10, 10, 1.0), {robot});
    const SearchResult result = p.state.plan(0, {.start_delay = 2.5}, p.never);
    ASSERT_TRUE(result.trajectory);
    EXPECT_NEAR(result.trajectory->cost, turns ? 1.0 : 0.0, 1e-12);
    p.reservations.follow(0, *result.trajectory);
    expect_safe(p.reservations);
  }
}

TEST(AaSipp, DoesNotRotateAtGoalWithoutHeading) {
  Planning p(OccupancyGrid(10, 10, 1.0), {robot_at(1.5, 1.5).to(6.5, 1.5)});
  EXPECT_NEAR(plan_first(p).cost, 5.0, 1e-12);
}

TEST(AaSipp, RotatesToGoalHeadingAtTheEnd) {
  Planning p(OccupancyGrid(10, 10, 1.0), {robot_at(1.5, 1.5).to(6.5, 1.5, -kPi / 2)});
  const Trajectory trajectory = plan_first(p);
  EXPECT_NEAR(trajectory.moves.back().t_end, 5.0, 1e-12);
  EXPECT_NEAR(trajectory.cost, 6.0, 1e-12);
}

TEST(AaSipp, KeepsExactStartAndGoalOffLattice) {
  Planning p(OccupancyGrid(10, 10, 1.0), {robot_at(1.23, 1.71).to(7.06, 8.3)});
  const Trajectory trajectory = plan_first(p);
  EXPECT_EQ(trajectory.start, Position(1.23, 1.71));
  EXPECT_EQ(trajectory.end(), Position(7.06, 8.3));
  EXPECT_EQ(trajectory.moves.size(), 1u);
}

TEST(AaSipp, DepartsWhenPassingRobotJustTouches) {
  Planning p(crossing(), {robot_at(0.5, 2.5).to(8.5, 2.5), robot_at(4.5, 4.5).to(4.5, 0.5)});
  p.reservations.follow(
      1, through({{4.5, 4.5}, {4.5, 0.5}}, 2.0));  // in the middle at t = 4, as robot 0 would be
  EXPECT_NEAR(plan_first(p).cost, 8.0 + 0.8 * std::sqrt(2.0), kTime);
}

TEST(AaSipp, GoesFirstIfRobotsJustTouch) {
  Planning p(crossing(), {robot_at(0.5, 2.5).to(8.5, 2.5), robot_at(4.5, 4.5).to(4.5, 0.5)});
  p.reservations.follow(1, through({{4.5, 4.5}, {4.5, 0.5}}, 2.0 + 0.8 * std::sqrt(2.0)));
  EXPECT_NEAR(plan_first(p).cost, 8.0, kTime);
}

TEST(AaSipp, StepsIntoBayToLetAnotherRobotPass) {
  Planning p(support::ascii_map({"###.###",  //
                                 "......."}),
             {robot_at(0.5, 0.5).to(6.5, 0.5), robot_at(6.5, 0.5).to(0.5, 0.5)});
  p.reservations.follow(1, through({{6.5, 0.5}, {0.5, 0.5}}, 6.0));
  const Trajectory trajectory = plan_first(p);
  const bool in_bay = std::any_of(trajectory.moves.begin(), trajectory.moves.end(),
                                  [](const auto& move) { return move.path.to == Position(3.5, 1.5); });
  EXPECT_TRUE(in_bay);
  EXPECT_GT(trajectory.cost, 9.0) << "the other robot is at the bay then";
}

TEST(AaSipp, ArrivesAtGoalOnceItIsFree) {
  Planning p(OccupancyGrid(10, 1, 1.0), {robot_at(0.5, 0.5).to(5.5, 0.5), robot_at(5.5, 0.5).to(9.5, 0.5)});
  p.reservations.follow(1, through({{5.5, 0.5}, {9.5, 0.5}}, 10.0));
  EXPECT_NEAR(plan_first(p).cost, 10.8, kTime) << "the other robot is a diameter ahead";
}

TEST(AaSipp, DoesNotRestAtGoalBeforeOthersHavePassed) {
  Planning p(crossing(), {robot_at(0.5, 2.5).to(4.5, 2.5), robot_at(4.5, 4.5).to(4.5, 0.5)});
  p.reservations.follow(1, through({{4.5, 4.5}, {4.5, 0.5}}, 20.0));
  EXPECT_NEAR(plan_first(p).cost, 22.0 + 0.8 * std::sqrt(2.0), kTime);
}

TEST(AaSipp, DoesNotMoveIfGoalIsStart) {
  Planning p(crossing(), {robot_at(4.5, 2.5, 1.0).to(4.5, 2.5)});
  const Trajectory trajectory = plan_first(p);
  EXPECT_TRUE(trajectory.moves.empty());
  EXPECT_EQ(trajectory.cost, 0.0);
}

TEST(AaSipp, RotatesInPlaceIfOnlyHeadingDiffers) {
  Planning p(crossing(), {robot_at(4.5, 2.5).to(4.5, 2.5, kPi)});
  const Trajectory trajectory = plan_first(p);
  EXPECT_TRUE(trajectory.moves.empty());
  EXPECT_NEAR(trajectory.cost, 2.0, 1e-12);
}

TEST(AaSipp, StepsAsideAndReturnsIfGoalIsStart) {
  Planning p(crossing(), {robot_at(4.5, 2.5).to(4.5, 2.5), robot_at(0.5, 2.5).to(8.5, 2.5)});
  p.reservations.follow(1, through({{0.5, 2.5}, {8.5, 2.5}}, 1.0));
  const Trajectory trajectory = plan_first(p);
  ASSERT_GE(trajectory.moves.size(), 2u);
  EXPECT_EQ(trajectory.end(), Position(4.5, 2.5));
  EXPECT_GE(trajectory.cost, 5.0 + 0.8 * std::sqrt(2.0) - kTime)
      << "the other robot is in the middle at t = 5";
}

TEST(AaSipp, StepsAsideAndReturnsOffLattice) {
  Planning p(crossing(), {robot_at(4.55, 2.45).to(4.55, 2.45), robot_at(0.5, 2.5).to(8.5, 2.5)});
  p.reservations.follow(1, through({{0.5, 2.5}, {8.5, 2.5}}, 1.0));
  EXPECT_EQ(plan_first(p).end(), Position(4.55, 2.45));
}

TEST(AaSipp, ProvesThatNoPathLeadsPastParkedRobot) {
  Planning p(crossing(), {robot_at(0.5, 2.5).to(8.5, 2.5), robot_at(4.5, 2.5), robot_at(8.0, 2.5)});
  p.reservations.stay_in_place(1);
  const SearchResult result = p.state.plan(0, kExact, p.never);
  EXPECT_FALSE(result.trajectory);
  EXPECT_TRUE(result.complete);
}

TEST(AaSipp, RejectsOccupiedGoalWithoutExpansions) {
  Planning p(OccupancyGrid(9, 5, 1.0), {robot_at(0.5, 2.5).to(8.5, 2.5), robot_at(8.0, 2.5)});
  p.reservations.stay_in_place(1);
  const SearchResult result = p.state.plan(0, kExact, p.never);
  EXPECT_FALSE(result.trajectory);
  EXPECT_TRUE(result.complete);
  EXPECT_EQ(result.expansions, 0);
}

TEST(AaSipp, AcceptsOnlyCostsBelowBound) {
  Planning p(maze(), {robot_at(0.5, 0.5).to(27.5, 8.5)});
  const double cost = p.state.plan(0, kExact, p.never).trajectory->cost;
  EXPECT_TRUE(p.state.plan(0, {.bound = cost + 0.1, .heuristic_weight = 1.0}, p.never).trajectory);
  const SearchResult result = p.state.plan(0, {.bound = cost - 0.1, .heuristic_weight = 1.0}, p.never);
  EXPECT_FALSE(result.trajectory);
  EXPECT_TRUE(result.complete);
}

TEST(AaSipp, ReportsThatItWasCutOff) {
  Planning p(maze(), {robot_at(0.5, 0.5).to(27.5, 8.5)});
  const SearchResult result = p.state.plan(0, kExact, met());
  EXPECT_FALSE(result.trajectory);
  EXPECT_FALSE(result.complete);
}

TEST(AaSipp, SuboptimalityNeverLowersCost) {
  Planning p(maze(), {robot_at(0.5, 0.5).to(27.5, 8.5)});
  const double best = p.state.plan(0, kExact, p.never).trajectory->cost;
  const double good = p.state.plan(0, {.suboptimality = 0.05}, p.never).trajectory->cost;
  EXPECT_GE(good, best - kTime);
}

TEST(AaSipp, RepeatsResultAfterOtherSearches) {
  Planning p(maze(), {robot_at(0.5, 0.5).to(27.5, 8.5), robot_at(0.5, 8.5).to(0.5, 7.5)});
  const SearchResult first = p.state.plan(0, kExact, p.never);
  p.state.plan(1, kExact, p.never);
  const SearchResult second = p.state.plan(0, kExact, p.never);
  EXPECT_EQ(first.trajectory->cost, second.trajectory->cost);
  EXPECT_EQ(first.trajectory->moves.size(), second.trajectory->moves.size());
  EXPECT_EQ(first.expansions, second.expansions);
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
