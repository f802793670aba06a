// The search for a robot that executes committed actions first.

#include <gtest/gtest.h>

#include <numbers>
#include <vector>

#include "core/plan/collect_plan.h"
#include "core/sipp/aa_sipp.h"
#include "tests/core/support/planning.h"

namespace fleetplan::core {
namespace TEST_FILE {

using support::robot_at;
using Type = Action::Type;

constexpr double kPi = std::numbers::pi;
/// Seconds: the search keeps distances to within half of the contact tolerance.
constexpr double kTime = 1e-8;

Robot with_committed(Robot robot, std::vector<Action> committed) {
  robot.committed = std::move(committed);
  return robot;
}

Action committed_move(const Pose& from, const Position& to, double t_start, double t_end) {
  return {Type::translate, t_start, t_end, from, {to, from.theta}};
}

Action committed_wait(const Pose& at, double t_start, double t_end) {
  return {Type::wait, t_start, t_end, at, at};
}

/// From (1.5, 2.5) slowly to (3.5, 2.5) at t = 4.
std::vector<Action> slow_move() { return {committed_move({{1.5, 2.5}, 0.0}, {3.5, 2.5}, 0.0, 4.0)}; }

Trajectory plan_exactly(Planning& p, const SearchSettings& limits = kExact) {
  const SearchResult result = p.state.plan(0, limits, p.never);
  EXPECT_TRUE(result.trajectory);
  return result.trajectory.value_or(Trajectory());
}

TEST(AaSippCommitted, GoesOnFromTheEndOfTheCommittedActions) {
  Planning p(OccupancyGrid(10, 5, 1.0), {with_committed(robot_at(1.5, 2.5).to(8.5, 2.5), slow_move())});
  const Trajectory trajectory = plan_exactly(p);
  ASSERT_EQ(trajectory.moves.size(), 2u) << "moves are not joined across the end of the committed ones";
  EXPECT_EQ(trajectory.start, Position(1.5, 2.5));
  EXPECT_EQ(trajectory.moves[0].t_end, 4.0);
  EXPECT_EQ(trajectory.moves[1].t_start, 4.0);
  EXPECT_EQ(trajectory.moves[1].path.from, Position(3.5, 2.5));
  EXPECT_NEAR(trajectory.cost, 4.0 + 5.0, 1e-12);
}

TEST(AaSippCommitted, ActionsBeginWithTheCommittedOnes) {
  std::vector<Action> committed = slow_move();
  committed.push_back(committed_wait({{3.5, 2.5}, 0.0}, 4.0, 4.7));
  Planning p(OccupancyGrid(10, 5, 1.0), {with_committed(robot_at(1.5, 2.5).to(3.5, 4.5), committed)});
  const std::vector<Action> actions = to_actions(p.instance.problem().robots()[0], plan_exactly(p));
  ASSERT_EQ(actions.size(), 4u);
  EXPECT_EQ(actions[0].t_end, 4.0);
  EXPECT_EQ(actions[1].t_end, 4.7);
  EXPECT_EQ(actions[1].type, Type::wait);
  EXPECT_EQ(actions[2].type, Type::rotate);
  EXPECT_EQ(actions[2].t_start, 4.7);
  EXPECT_EQ(actions[3].type, Type::translate);
  EXPECT_NEAR(actions[3].t_end, 4.7 + 1.0 + 2.0, 1e-12);
}

TEST(AaSippCommitted, NothingFollowsIfTheyEndAtTheGoal) {
  Planning p(OccupancyGrid(10, 5, 1.0), {with_committed(robot_at(1.5, 2.5).to(3.5, 2.5), slow_move())});
  const Trajectory trajectory = plan_exactly(p);
  EXPECT_EQ(trajectory.moves.size(), 1u);
  EXPECT_EQ(trajectory.cost, 4.0);
  EXPECT_EQ(to_actions(p.instance.problem().robots()[0], trajectory).size(), 1u);
}

TEST(AaSippCommitted, RotatesToTheGoalHeadingAfterThem) {
  Planning p(OccupancyGrid(10, 5, 1.0),
             {with_committed(robot_at(1.5, 2.5).to(3.5, 2.5, kPi / 2), slow_move())});
  EXPECT_NEAR(plan_exactly(p).cost, 5.0, 1e-12);
}

TEST(AaSippCommitted, StartDelayBeginsAfterThem) {
  Planning p(OccupancyGrid(10, 5, 1.0), {with_committed(robot_at(1.5, 2.5).to(8.5, 2.5), slow_move())});
  SearchSettings limits = kExact;
  limits.start_delay = 2.5;
  EXPECT_NEAR(plan_exactly(p, limits).cost, 4.0 + 2.5 + 5.0, 1e-12);
}

TEST(AaSippCommitted, BeginsInTheSafeIntervalOfTheirEnd) {
  // Robot 1 passes the end of the committed move before robot 0 is there, and robot 2 passes it at t = 20.
  Planning p(OccupancyGrid(10, 5, 1.0), {with_committed(robot_at(1.5, 2.5).to(3.5, 2.5), slow_move()),
                                         robot_at(3.5, 4.5).to(3.5, 0.5), robot_at(3.5, 0.5).to(3.5, 4.5)});
  p.reservations.follow(1, through({{3.5, 4.5}, {3.5, 0.5}, {9.5, 0.5}}, 0.0));
  p.reservations.follow(2, through({{3.5, 0.5}, {3.5, 4.5}}, 18.0));
  const Trajectory trajectory = plan_exactly(p);
  ASSERT_GE(trajectory.moves.size(), 3u) << "it steps aside and returns";
  EXPECT_EQ(trajectory.moves[0].t_end, 4.0);
  EXPECT_GE(trajectory.moves[1].t_start, 4.0);
  EXPECT_GT(trajectory.cost, 20.0);
  EXPECT_LT(trajectory.cost, 22.0 + kTime);
}

TEST(AaSippCommitted, FindsNoPlanIfTheirEndIsOccupiedThen) {
  Planning p(OccupancyGrid(10, 5, 1.0),
             {with_committed(robot_at(1.5, 2.5).to(8.5, 2.5), slow_move()), robot_at(3.5, 0.5).to(3.5, 4.5)});
  p.reservations.follow(1, through({{3.5, 0.5}, {3.5, 4.5}}, 2.0));  // at (3.5, 2.5) at t = 4
  EXPECT_FALSE(p.state.plan(0, kExact, p.never).trajectory);
}

TEST(AaSippCommitted, AcceptsOnlyCostsBelowTheBoundCommittedTimeIncluded) {
  Planning p(OccupancyGrid(10, 5, 1.0), {with_committed(robot_at(1.5, 2.5).to(8.5, 2.5), slow_move())});
  SearchSettings limits = kExact;
  limits.bound = 9.0;
  EXPECT_FALSE(p.state.plan(0, limits, p.never).trajectory);
  limits.bound = 9.001;
  EXPECT_TRUE(p.state.plan(0, limits, p.never).trajectory);
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
