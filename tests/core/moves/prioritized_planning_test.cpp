#include "core/moves/prioritized_planning.h"

#include <gtest/gtest.h>

#include "core/moves/repair.h"
#include "tests/core/support/planning.h"

namespace fleetplan::core {
namespace TEST_FILE {

using support::expect_safe;
using support::robot_at;
using Priority = PlanOptions::Priority;
using Reordering = PlanOptions::Reordering;
using Robots = std::vector<std::size_t>;

/// Robot 0 has a short path into the doorway between two rooms and stays there. Robot 1 has to pass the
/// doorway first. Robot 2 remains in its room.
struct Doorway : Planning {
  Doorway(Priority priority, Reordering reordering)
      : Planning(support::ascii_map({"....#....",  //
                                     ".........",  //
                                     "....#...."}),
                 {robot_at(2.5, 1.5).to(4.5, 1.5), robot_at(0.5, 1.5).to(8.5, 1.5),
                  robot_at(8.5, 0.5).to(5.5, 0.5)},
                 chosen(priority, reordering)) {}

  static PlanOptions chosen(Priority priority, Reordering reordering) {
    PlanOptions options;
    options.priority = priority;
    options.reordering = reordering;
    return options;
  }
};

Robots robots_of(const PrioritizedResult& result) {
  Robots robots;
  for (const Unplanned& robot : result.unplanned) robots.push_back(robot.robot);
  return robots;
}

PrioritizedResult run(Planning& p) {
  return plan_prioritized(p.state, p.movers(), p.random, PlanningTime::until(StopCondition::never()),
                          p.progress);
}

/// Plans all robots, and returns the number of attempts.
std::int64_t attempts_to_solve(Planning& p) {
  const auto result = run(p);
  EXPECT_TRUE(result.unplanned.empty());
  EXPECT_FALSE(result.cut_off);
  expect_safe(p.reservations);
  return result.attempts;
}

TEST(Prioritized, NeedsOneAttemptWhereTheFirstOrderWorks) {
  Doorway p(Priority::longest_first, Reordering::raise_failed);
  EXPECT_EQ(attempts_to_solve(p), 1);
}

TEST(Prioritized, NeedsOneAttemptWhereAGoalIsOnTheWayOfOthers) {
  Doorway p(Priority::shortest_first, Reordering::raise_failed);
  EXPECT_EQ(attempts_to_solve(p), 1);
}

TEST(Prioritized, RaisesTheRobotThatFailed) {
  Doorway p(Priority::as_listed, Reordering::raise_failed);
  EXPECT_EQ(attempts_to_solve(p), 2);
}

TEST(Prioritized, TriesRandomOrders) {
  Doorway p(Priority::as_listed, Reordering::random);
  const std::int64_t attempts = attempts_to_solve(p);
  EXPECT_GE(attempts, 2);
  EXPECT_LE(attempts, 6) << "there are no more orders";
}

TEST(Prioritized, PlansTheOtherRobotsWithoutReordering) {
  Doorway p(Priority::as_listed, Reordering::none);
  const auto result = run(p);
  ASSERT_EQ(robots_of(result), Robots{1});
  EXPECT_EQ(result.unplanned[0].blocked_by, Robots{0});
  EXPECT_EQ(result.attempts, 1);
  EXPECT_TRUE(p.reservations.trajectory(0));
  EXPECT_TRUE(p.reservations.trajectory(2)) << "its priority is below that of the robot that failed";
  expect_safe(p.reservations);
}

TEST(Prioritized, PlansTheOtherRobotsWhenOneIsBlockedByAParkedRobot) {
  for (const Reordering reordering : {Reordering::raise_failed, Reordering::random, Reordering::none}) {
    Planning p(support::ascii_map({"....#....",  //
                                   ".........",  //
                                   "....#...."}),
               {robot_at(4.5, 1.5), robot_at(0.5, 1.5).to(8.5, 1.5), robot_at(8.5, 0.5).to(5.5, 0.5),
                robot_at(2.5, 2.5).to(0.5, 2.5)},
               Doorway::chosen(Priority::shortest_first, reordering));
    p.reservations.stay_in_place(0);
    const auto result = run(p);
    ASSERT_EQ(robots_of(result), Robots{1});
    EXPECT_EQ(static_cast<int>(result.unplanned[0].reason),
              static_cast<int>(Unplanned::Reason::blocked_by_robots));
    EXPECT_EQ(result.unplanned[0].blocked_by, Robots{0});
    EXPECT_FALSE(result.cut_off);
    expect_safe(p.reservations);
  }
}

TEST(Prioritized, PlansNothingWithoutMovers) {
  Planning p(OccupancyGrid(4, 4, 1.0), {robot_at(1, 1)});
  const auto result =
      plan_prioritized(p.state, {}, p.random, PlanningTime::until(StopCondition::never()), p.progress);
  EXPECT_TRUE(result.unplanned.empty());
  EXPECT_FALSE(result.cut_off);
}

TEST(Prioritized, CompletesAPartialPlanAfterTheTimeForAttempts) {
  Planning p(maze(), {robot_at(0.5, 0.5).to(27.5, 8.5), robot_at(0.5, 1.5).to(0.5, 8.5)});
  const auto result =
      plan_prioritized(p.state, p.movers(), p.random,
                       PlanningTime{met(), StopCondition::never(), StopCondition::never()}, p.progress);
  EXPECT_TRUE(result.unplanned.empty()) << "there is time left to complete";
  EXPECT_TRUE(result.cut_off);
  expect_safe(p.reservations);
}

TEST(Prioritized, LeavesAllRobotsUnplannedAfterStop) {
  Planning p(maze(), {robot_at(0.5, 0.5).to(27.5, 8.5), robot_at(0.5, 1.5).to(0.5, 8.5)});
  const auto result =
      plan_prioritized(p.state, p.movers(), p.random, PlanningTime{met(), met(), met()}, p.progress);
  EXPECT_EQ(robots_of(result), (Robots{0, 1}));
  EXPECT_TRUE(result.cut_off);
  EXPECT_EQ(static_cast<int>(result.unplanned[0].reason),
            static_cast<int>(Unplanned::Reason::budget_exhausted));
  expect_safe(p.reservations);
}

TEST(Prioritized, GoesOnAfterKeepingASafePlan) {
  Planning p(maze(), {robot_at(0.5, 0.5).to(27.5, 8.5), robot_at(0.5, 1.5).to(0.5, 8.5)});
  const auto result = plan_prioritized(p.state, p.movers(), p.random,
                                       PlanningTime{met(), met(), StopCondition::never()}, p.progress);
  EXPECT_TRUE(result.unplanned.empty()) << "the time for the safe plan was over, but not all of it";
  EXPECT_TRUE(result.cut_off);
  expect_safe(p.reservations);
}

/// Two robots that cannot change places, and three others.
Planning two_in_a_corridor() {
  return Planning(
      support::ascii_map({".......##",  //
                          "#########",  //
                          "........."}),
      {robot_at(0.5, 2.5).to(6.5, 2.5), robot_at(6.5, 2.5, 3.0).to(0.5, 2.5), robot_at(0.5, 0.5).to(4.5, 0.5),
       robot_at(1.5, 0.5).to(6.5, 0.5), robot_at(3.5, 0.5).to(8.5, 0.5)});
}

TEST(Prioritized, TriesOtherOrdersAfterARobotWasGivenUp) {
  Planning p = two_in_a_corridor();
  Planning once = two_in_a_corridor();
  const OrderingResult first =
      repair_all(once.state, {0, 1, 2, 3, 4}, once.steps, once.random, once.never, once.progress);
  const auto result = run(p);
  EXPECT_EQ(robots_of(result), (Robots{0, 1})) << "each is in the other's way";
  EXPECT_GT(result.attempts, 2 * first.attempts);
  expect_safe(p.reservations);
}

TEST(Prioritized, PlansAgainByExpectedArrivalsAfterManyFailuresInAnotherOrder) {
  // Robots 0 and 1 cannot change places; 2, the smallest, and 3 would meet in the middle of the hall.
  PlanOptions options;
  options.priority = Priority::as_listed;
  Planning p(support::ascii_map({".......##",  //
                                 "#########",  //
                                 ".........",  //
                                 ".........",  //
                                 ".........",  //
                                 ".........",  //
                                 "........."}),
             {robot_at(0.5, 6.5).to(6.5, 6.5), robot_at(6.5, 6.5, 3.0).to(0.5, 6.5),
              robot_at(2.5, 2.5).to(8.5, 2.5).radius(0.2),
              robot_at(4.5, 4.5, -1.5707963267948966).to(4.5, 0.5), robot_at(8.5, 4.5).to(7.5, 4.5)},
             options);
  const auto result = run(p);
  EXPECT_EQ(robots_of(result), (Robots{0, 1}));
  EXPECT_GT(result.attempts, 15);
  ASSERT_TRUE(p.reservations.trajectory(2) && p.reservations.trajectory(3));
  EXPECT_NEAR(p.reservations.trajectory(3)->cost, 4.0, 1e-9);
  EXPECT_GT(p.reservations.trajectory(2)->cost, 6.1) << "planned later, although listed before";
  expect_safe(p.reservations);
}

TEST(Prioritized, DoesNotTryOtherOrdersForARobotThatHasNoPathAtAll) {
  // Robot 0 is parked in the only doorway; five others want to pass it or move in their room.
  Planning p(
      support::ascii_map({"....#....",  //
                          ".........",  //
                          "....#...."}),
      {robot_at(4.5, 1.5), robot_at(0.5, 1.5).to(8.5, 1.5), robot_at(8.5, 0.5).to(5.5, 0.5),
       robot_at(2.5, 2.5).to(0.5, 2.5), robot_at(6.5, 2.5).to(8.5, 2.5), robot_at(2.5, 0.5).to(1.5, 0.5)});
  p.reservations.stay_in_place(0);
  const auto result = run(p);
  EXPECT_EQ(robots_of(result), Robots{1});
  EXPECT_EQ(result.unplanned[0].blocked_by, Robots{0});
  EXPECT_LE(result.attempts, 3);
  EXPECT_FALSE(result.cut_off);
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
