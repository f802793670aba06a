// The search for a robot that visits several goals, with services.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "core/model/itinerary.h"
#include "core/plan/collect_plan.h"
#include "core/plan/planner.h"
#include "core/sipp/aa_sipp.h"
#include "tests/core/support/planning.h"
#include "tests/support/expect_bounds.h"
#include "tests/support/random_problem.h"

namespace fleetplan::core {
namespace TEST_FILE {

using support::expect_safe;
using support::robot_at;
using Type = Action::Type;

constexpr double kPi = std::numbers::pi;
/// Seconds: the search keeps distances to within half of the contact tolerance.
constexpr double kTime = 1e-8;

/// The last of these goals is Robot::goal.
Robot with_goals(Robot robot, std::vector<Goal> goals) {
  robot.goal = goals.back();
  goals.pop_back();
  robot.via = std::move(goals);
  return robot;
}

struct Planned {
  Trajectory trajectory;
  std::vector<Action> actions;
  std::vector<Visit> visits;
};

/// Plans robot 0, reserves the result and checks it.
Planned plan_first(Planning& p, const SearchSettings& limits = kExact) {
  const SearchResult result = p.state.plan(0, limits, p.never);
  EXPECT_TRUE(result.trajectory);
  if (!result.trajectory) return {};
  const Robot& robot = p.instance.problem().robots()[0];
  p.reservations.follow(0, *result.trajectory);
  expect_safe(p.reservations);
  Planned planned{*result.trajectory, to_actions(robot, *result.trajectory), {}};
  planned.visits = visits_of(robot, planned.actions);
  EXPECT_EQ(planned.visits.size(), robot.goal_count());
  EXPECT_EQ(planned.visits.back().t_leave, kForever);
  EXPECT_NEAR(planned.actions.empty() ? 0.0 : planned.actions.back().t_end, planned.trajectory.cost, 1e-9);
  return planned;
}

TEST(AaSippSequence, VisitsGoalsInTheirOrder) {
  Planning p(OccupancyGrid(10, 10, 1.0),
             {with_goals(robot_at(1.5, 1.5), {{{6.5, 1.5}, {}}, {{6.5, 4.5}, {}}, {{2.5, 4.5}, {}}})});
  const Planned planned = plan_first(p);
  EXPECT_NEAR(planned.trajectory.cost, 5.0 + 1.0 + 3.0 + 1.0 + 4.0, 1e-12);
  ASSERT_EQ(planned.visits.size(), 3u);
  EXPECT_NEAR(planned.visits[0].t_arrive, 5.0, 1e-12);
  EXPECT_EQ(planned.visits[0].t_leave, planned.visits[0].t_arrive);
  EXPECT_NEAR(planned.visits[1].t_arrive, 9.0, 1e-12);
  EXPECT_NEAR(planned.visits[2].t_arrive, 14.0, 1e-12);
  EXPECT_EQ(planned.trajectory.visits.size(), 2u) << "not the last goal";
}

TEST(AaSippSequence, RestsAtAGoalOnItsStraightWay) {
  Planning p(OccupancyGrid(10, 3, 1.0),
             {with_goals(robot_at(1.5, 1.5), {{{4.5, 1.5}, {}}, {{8.5, 1.5}, {}}})});
  const Planned planned = plan_first(p);
  ASSERT_EQ(planned.trajectory.moves.size(), 2u) << "moves are not joined where a goal is visited";
  EXPECT_NEAR(planned.trajectory.cost, 7.0, 1e-12);
  EXPECT_NEAR(planned.visits[0].t_arrive, 3.0, 1e-12);
}

TEST(AaSippSequence, AGoalThatIsRestedAtOnTheWayHasAnAddedWaitOfItsOwn) {
  PlanOptions options;
  options.wait_before_move = 0.5;
  Planning p(OccupancyGrid(10, 3, 1.0),
             {with_goals(robot_at(1.5, 1.5), {{{4.5, 1.5}, {}}, {{8.5, 1.5}, {}}})}, options);
  EXPECT_NEAR(plan_first(p).trajectory.cost, 0.5 + 3.0 + 0.5 + 4.0, 1e-12);
}

TEST(AaSippSequence, ServesInOneWaitInThePoseOfTheGoal) {
  Planning p(OccupancyGrid(10, 10, 1.0),
             {with_goals(robot_at(1.5, 1.5), {{{6.5, 1.5}, kPi / 2, 3.0}, {{6.5, 4.5}, {}, 2.0}})});
  const Planned planned = plan_first(p);
  ASSERT_EQ(planned.actions.size(), 5u);
  EXPECT_EQ(planned.actions[0].type, Type::translate);
  EXPECT_EQ(planned.actions[1].type, Type::rotate);
  EXPECT_EQ(planned.actions[2].type, Type::wait);
  EXPECT_EQ(planned.actions[2].goal, std::optional<std::size_t>(0));
  EXPECT_NEAR(planned.actions[2].t_start, 6.0, 1e-12);
  EXPECT_NEAR(planned.actions[2].t_end, 9.0, 1e-12);
  EXPECT_EQ(planned.actions[3].type, Type::translate);
  EXPECT_EQ(planned.actions[4].goal, std::optional<std::size_t>(1));
  EXPECT_NEAR(planned.trajectory.cost, 6.0 + 3.0 + 3.0 + 2.0, 1e-12) << "the last service included";
  EXPECT_NEAR(planned.visits[1].t_arrive, 12.0, 1e-12);
}

TEST(AaSippSequence, WaitsForNotBefore) {
  Planning p(OccupancyGrid(10, 3, 1.0),
             {with_goals(robot_at(1.5, 1.5), {{{4.5, 1.5}, {}, 2.0, 10.0}, {{8.5, 1.5}, {}, 0.0, 30.0}})});
  const Planned planned = plan_first(p);
  EXPECT_NEAR(planned.visits[0].t_arrive, 3.0, 1e-12);
  EXPECT_NEAR(planned.visits[0].t_leave, 12.0, 1e-12);
  EXPECT_NEAR(planned.visits[1].t_arrive, 16.0, 1e-12);
  EXPECT_EQ(planned.trajectory.cost, 30.0);
  EXPECT_EQ(planned.actions.back().goal, std::optional<std::size_t>(1));
}

TEST(AaSippSequence, MayVisitItsStartAndTheSameGoalAgain) {
  Planning p(OccupancyGrid(10, 3, 1.0), {with_goals(robot_at(1.5, 1.5), {{{1.5, 1.5}, {}, 2.0},
                                                                         {{4.5, 1.5}, {}, 1.0},
                                                                         {{4.5, 1.5}, {}, 1.0},
                                                                         {{1.5, 1.5}, {}},
                                                                         {{4.5, 1.5}, {}}})});
  const Planned planned = plan_first(p);
  EXPECT_NEAR(planned.trajectory.cost, 2.0 + 3.0 + 1.0 + 1.0 + 2.0 + 3.0 + 2.0 + 3.0, 1e-12);
  ASSERT_EQ(planned.visits.size(), 5u);
  EXPECT_NEAR(planned.visits[1].t_arrive, 5.0, 1e-12);
  EXPECT_NEAR(planned.visits[2].t_arrive, 6.0, 1e-12) << "one rest serves both";
  EXPECT_NEAR(planned.visits[2].t_leave, 7.0, 1e-12);
}

TEST(AaSippSequence, StaysAtItsStartIfAllGoalsAreThere) {
  Planning p(OccupancyGrid(10, 3, 1.0),
             {with_goals(robot_at(1.5, 1.5), {{{1.5, 1.5}, {}}, {{1.5, 1.5}, {}}})});
  const Planned planned = plan_first(p);
  EXPECT_TRUE(planned.actions.empty());
  EXPECT_EQ(planned.trajectory.cost, 0.0);
}

TEST(AaSippSequence, KeepsGoalsOffTheLatticeExact) {
  Planning p(
      OccupancyGrid(10, 10, 1.0),
      {with_goals(robot_at(1.23, 1.71), {{{7.06, 1.9}, {}, 1.0}, {{7.31, 2.2}, {}}, {{2.1, 8.3}, {}}})});
  const Planned planned = plan_first(p);
  ASSERT_GE(planned.trajectory.moves.size(), 3u);
  EXPECT_EQ(planned.trajectory.moves[0].path.to, Position(7.06, 1.9));
  EXPECT_EQ(planned.trajectory.moves[1].path.to, Position(7.31, 2.2));
  EXPECT_EQ(planned.trajectory.end(), Position(2.1, 8.3));
}

TEST(AaSippSequence, GoesAroundWallsBetweenGoals) {
  Planning p(maze(), {with_goals(robot_at(0.5, 8.5),
                                 {{{27.5, 4.5}, {}, 1.0}, {{0.5, 0.5}, {}, 2.0}, {{0.5, 8.5}, {}}})});
  const Planned planned = plan_first(p);
  EXPECT_GT(planned.trajectory.cost, 130.0) << "twice through parts of the maze";
}

TEST(AaSippSequence, LeavesAGoalThatAnotherRobotPassesAndComesBack) {
  // The service takes 10 s, and robot 1 passes the goal after 8 s.
  Planning p(OccupancyGrid(10, 5, 1.0),
             {with_goals(robot_at(1.5, 2.5), {{{4.5, 2.5}, {}, 10.0}, {{8.5, 2.5}, {}}}),
              robot_at(4.5, 4.5).to(4.5, 0.5)});
  p.reservations.follow(1, through({{4.5, 4.5}, {4.5, 0.5}}, 6.0));
  const Planned planned = plan_first(p);
  EXPECT_GT(planned.visits[0].t_arrive, 8.0);
  EXPECT_NEAR(planned.visits[0].t_leave, planned.visits[0].t_arrive + 10.0, 1e-9);
  EXPECT_LT(planned.trajectory.cost, 8.0 + 1.0 + 10.0 + 4.0 + 0.5);
}

TEST(AaSippSequence, ServesBeforeAnotherRobotPassesIfThereIsTime) {
  Planning p(OccupancyGrid(10, 5, 1.0),
             {with_goals(robot_at(1.5, 2.5), {{{4.5, 2.5}, {}, 3.0}, {{8.5, 2.5}, {}}}),
              robot_at(4.5, 4.5).to(4.5, 0.5)});
  p.reservations.follow(1, through({{4.5, 4.5}, {4.5, 0.5}}, 6.0));
  const Planned planned = plan_first(p);
  EXPECT_NEAR(planned.trajectory.cost, 3.0 + 3.0 + 4.0, kTime);
}

TEST(AaSippSequence, ProvesQuicklyThatAGoalOnTheWayIsNeverFree) {
  Planning p(OccupancyGrid(10, 5, 1.0),
             {with_goals(robot_at(1.5, 2.5), {{{4.5, 2.5}, {}, 3.0}, {{8.5, 2.5}, {}}}), robot_at(4.5, 2.5)});
  p.reservations.stay_in_place(1);
  const SearchResult result = p.state.plan(0, {}, p.never);
  EXPECT_FALSE(result.trajectory);
  EXPECT_TRUE(result.complete);
  EXPECT_EQ(result.expansions, 0);
}

TEST(AaSippSequence, FindsThatAGoalOnTheWayIsOutOfReach) {
  Planning p(support::ascii_map({"....#..",  //
                                 "....#..",  //
                                 "....###",  //
                                 "......."}),
             {with_goals(robot_at(0.5, 0.5), {{{5.5, 2.5}, {}}, {{6.5, 0.5}, {}}})});
  const Plan result = plan(p.problem, {}, p.never);
  ASSERT_EQ(result.unplanned.size(), 1u);
  EXPECT_EQ(result.unplanned[0].reason, Unplanned::Reason::goal_unreachable);
}

TEST(AaSippSequence, GoesOnWithAServiceThatCommittedActionsHaveBegun) {
  Robot robot = with_goals(robot_at(1.5, 1.5), {{{3.5, 1.5}, {}, 5.0}, {{6.5, 1.5}, {}}});
  robot.committed = {{Type::translate, 0.0, 2.0, robot.start, {{3.5, 1.5}, 0.0}},
                     {Type::wait, 2.0, 4.0, {{3.5, 1.5}, 0.0}, {{3.5, 1.5}, 0.0}, 0}};
  Planning p(OccupancyGrid(10, 3, 1.0), {robot});
  const Planned planned = plan_first(p);
  ASSERT_EQ(planned.actions.size(), 4u);
  EXPECT_EQ(planned.actions[2].goal, std::optional<std::size_t>(0));
  EXPECT_EQ(planned.actions[2].t_start, 4.0);
  EXPECT_EQ(planned.actions[2].t_end, 7.0);
  EXPECT_NEAR(planned.trajectory.cost, 10.0, 1e-12);
  EXPECT_EQ(planned.visits[0].t_arrive, 2.0);
  EXPECT_EQ(planned.visits[0].t_leave, 7.0);
}

TEST(AaSippSequence, GoesOnWithTheLastServiceInAPoseThatIsOffByATolerance) {
  Robot robot = with_goals(robot_at(1.5, 1.5), {{{3.5, 1.5}, 0.0, 5.0}});
  const Pose rest{{3.5 + 2e-7, 1.5}, 1e-7};
  robot.start.theta = 1e-7;
  robot.committed = {{Type::translate, 0.0, 2.5, robot.start, rest}, {Type::wait, 2.5, 4.0, rest, rest, 0}};
  Planning p(OccupancyGrid(10, 3, 1.0), {robot});
  const SearchResult result = p.state.plan(0, kExact, p.never);
  ASSERT_TRUE(result.trajectory);
  EXPECT_EQ(result.trajectory->cost, 7.5);
  const auto actions = to_actions(robot, *result.trajectory);
  ASSERT_EQ(actions.size(), 3u);
  EXPECT_EQ(actions[2].type, Type::wait);
}

TEST(AaSippSequence, NothingFollowsIfCommittedActionsHaveServedTheLastGoal) {
  Robot robot = with_goals(robot_at(1.5, 1.5), {{{3.5, 1.5}, {}, 1.0}});
  robot.committed = {{Type::translate, 0.0, 2.0, robot.start, {{3.5, 1.5}, 0.0}},
                     {Type::wait, 2.0, 4.0, {{3.5, 1.5}, 0.0}, {{3.5, 1.5}, 0.0}, 0}};
  Planning p(OccupancyGrid(10, 3, 1.0), {robot});
  const Planned planned = plan_first(p);
  EXPECT_EQ(planned.actions.size(), 2u);
  EXPECT_EQ(planned.trajectory.cost, 4.0);
}

/// Compares a robot alone on a random map with three goals to single searches one after the other, by the sum
/// of their costs. The goals on the way have no headings.
TEST(AaSippSequence, IsHardlyEverDearerThanSearchesOneAfterTheOther) {
  int count = 0;
  int dearer = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    support::Dice dice(seed);
    OccupancyGrid grid(14, 14, 1.0);
    for (int k = 0; k < 30; ++k) grid.block({dice.below(14), dice.below(14)});
    std::vector<Position> places;
    while (places.size() < 4) {
      const Cell cell{dice.below(14), dice.below(14)};
      if (!grid.blocked(cell)) places.push_back(grid.center(cell));
    }
    std::vector<Goal> goals;
    for (std::size_t k = 1; k < 4; ++k)
      goals.push_back({places[k], {}, dice.between(0.0, 3.0), dice.between(0.0, 20.0)});
    double chained = 0.0;
    Pose pose{places[0], 0.0};
    bool reachable = true;
    for (const Goal& goal : goals) {
      Robot robot =
          with_goals(robot_at(pose.position.x(), pose.position.y(), pose.theta), {{goal.position, {}}});
      Planning p(grid, {robot});
      const SearchResult result = p.state.plan(0, {}, p.never);
      if (!result.trajectory) reachable = false;
      if (!reachable) break;
      const auto actions = to_actions(robot, *result.trajectory);
      if (!actions.empty()) pose = actions.back().to;
      chained = std::max(chained + result.trajectory->cost, goal.not_before) + goal.service;
    }
    if (!reachable) continue;
    Planning p(grid, {with_goals(robot_at(places[0].x(), places[0].y()), goals)});
    const double cost = plan_first(p, {}).trajectory.cost;
    ++count;
    if (cost > 1.02 * chained + 1e-9) ++dearer;
    const Plan whole = plan(p.problem, {}, p.never);
    support::expect_bounded(whole);
    ASSERT_EQ(whole.plans.size(), 1u);
    EXPECT_EQ(whole.plans[0].visits.size(), 3u);
  }
  EXPECT_GT(count, 20);
  EXPECT_LE(dearer, 2) << "of " << count;
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
