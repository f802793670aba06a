#include "core/moves/expected_arrivals.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tests/core/support/planning.h"
#include "tests/support/random_problem.h"
#include "tests/support/step_limit.h"

namespace fleetplan::core {
namespace TEST_FILE {

using support::ascii_map;
using support::robot_at;

PriorityOrder order_of(Planning& p) { return order_by_expected_arrival(p.state, p.movers(), p.never).robots; }

TEST(ExpectedArrivals, ComeByTheLengthOfTheWayAndNotOfTheLine) {
  Planning p(maze(), {robot_at(5.5, 3.5).to(5.5, 5.5), robot_at(20.5, 0.5).to(8.5, 0.5)});
  EXPECT_EQ(order_of(p), (PriorityOrder{1, 0})) << "2 m along the line, and more than 40 m around a wall";
}

TEST(ExpectedArrivals, OfFastAndHeavyRobotsComeSooner) {
  Robot heavy = robot_at(1, 5).to(6, 5);
  heavy.weight = 10.0;
  Planning p(OccupancyGrid(10, 10, 1.0),
             {robot_at(1, 1).to(4, 1), robot_at(1, 3).to(4, 3).speeds(2.0, 1.0), heavy});
  EXPECT_EQ(order_of(p), (PriorityOrder{2, 1, 0}));
}

TEST(ExpectedArrivals, IncludeServicesAndGoalsBefore) {
  Robot waits = robot_at(0.5, 0.5).to(2.5, 0.5);
  waits.goal->service = 20.0;
  Robot visits = robot_at(0.5, 2.5).to(2.5, 2.5);
  visits.via.push_back({{8.5, 2.5}, std::nullopt});
  Planning p(OccupancyGrid(10, 5, 1.0), {waits, visits, robot_at(0.5, 4.5).to(9.5, 4.5)});
  EXPECT_EQ(order_of(p), (PriorityOrder{2, 1, 0})) << "9 s, 14 s and turns, and 22 s";
}

TEST(ExpectedArrivals, AreAfterThoseWhoHaveNoOtherWay) {
  // Robot 0 would be at its goal in the corridor before robot 1 passes there.
  Planning p(ascii_map({"....########....",  //
                        "................",  //
                        "....########...."}),
             {robot_at(3.5, 2.5).to(5.5, 1.5), robot_at(0.5, 1.5).to(15.5, 1.5)});
  EXPECT_EQ(order_of(p), (PriorityOrder{1, 0}));
}

TEST(ExpectedArrivals, AreNotDelayedByThoseWhoLoseLittleOnAnotherWay) {
  // The way through the lower corridor is as long, except for a few metres.
  Planning p(ascii_map({"....########....",  //
                        "................",  //
                        "....########....",  //
                        "................",  //
                        "....########...."}),
             {robot_at(3.5, 4.5).to(5.5, 3.5), robot_at(0.5, 3.5).to(15.5, 3.5)});
  EXPECT_EQ(order_of(p), (PriorityOrder{0, 1}));
}

TEST(ExpectedArrivals, CountTheWeightOfThoseWhoWait) {
  // The other way takes 10 m more, which is worth it only for a heavy robot that would wait 5 s.
  const auto order_with = [](double weight) {
    Robot waits = robot_at(1.5, 4.5).to(5.5, 5.5);
    waits.weight = weight;
    Planning p(ascii_map({"................",  //
                          "...##########...",  //
                          "...##########...",  //
                          "...##########...",  //
                          "...##########...",  //
                          "................"}),
               {waits, robot_at(0.5, 5.5).to(15.5, 5.5)});
    return order_of(p);
  };
  EXPECT_EQ(order_with(1.0), (PriorityOrder{1, 0}));
  EXPECT_EQ(order_with(4.0), (PriorityOrder{0, 1}));
}

TEST(ExpectedArrivals, AreDelayedByNobodyWhereTheRobotMakesWay) {
  Robot idle = robot_at(5.5, 1.5);
  idle.let_yield();
  Planning p(ascii_map({"....########....",  //
                        "................",  //
                        "....########...."}),
             {robot_at(0.5, 1.5).to(15.5, 1.5), idle});
  EXPECT_EQ(order_of(p), (PriorityOrder{1, 0})) << "it has arrived, and leaves when it is asked to";
}

TEST(ExpectedArrivals, OfRobotsWithoutAWayComeFirst) {
  Planning p(ascii_map({"...#....",  //
                        "...#....",  //
                        "...#...."}),
             {robot_at(4.5, 0.5).to(5.5, 0.5), robot_at(0.5, 1.5).to(7.5, 1.5)});
  EXPECT_EQ(order_of(p), (PriorityOrder{1, 0}));
}

TEST(ExpectedArrivals, LeaveTheOrderAsItIsWhenStopped) {
  Planning p(OccupancyGrid(10, 5, 1.0), {robot_at(0.5, 0.5).to(8.5, 0.5), robot_at(0.5, 2.5).to(2.5, 2.5)});
  const ExpectedOrder stopped = order_by_expected_arrival(p.state, {0, 1}, met());
  EXPECT_EQ(stopped.robots, (PriorityOrder{0, 1}));
  EXPECT_TRUE(stopped.cut_off);
  const ExpectedOrder expected = order_by_expected_arrival(p.state, {0, 1}, p.never);
  EXPECT_EQ(expected.robots, (PriorityOrder{1, 0}));
  EXPECT_FALSE(expected.cut_off);
}

/// Robot 0 goes to and fro on a line with the goals of a hundred others.
Planning to_and_fro(int times) {
  Robot robot = robot_at(0.5, 5.5).to(119.5, 5.5);
  for (int k = 0; k < times; ++k) robot.via.push_back({{k % 2 == 0 ? 118.5 : 1.5, 5.5}, std::nullopt});
  std::vector<Robot> robots{robot};
  for (int k = 0; k < 100; ++k) robots.push_back(robot_at(4.5 + k, 7.5).to(4.5 + k, 5.5));
  return Planning(OccupancyGrid(120, 11, 1.0), std::move(robots));
}

TEST(ExpectedArrivals, AskTheStopConditionWhileTheyLookAtManyPassages) {
  const auto steps = [](int times) {
    Planning p = to_and_fro(times);
    support::StepLimit limit;
    order_by_expected_arrival(p.state, p.movers(), support::counted(limit));
    return limit.steps();
  };
  EXPECT_GT(steps(400) - steps(200), 200 * 3) << "for each way, less than 2.5 without its passages";
}

TEST(ExpectedArrivals, AreAnOrderThatIsTheSameEachTimeOnRandomProblems) {
  int changed = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    support::Dice dice(seed);
    const Problem problem = support::random_problem(dice, 12);
    PlanOptions options = support::random_options(dice, problem);
    options.horizon.reset();
    const auto expected = [&] {
      Planning p(problem, options);
      return order_by_expected_arrival(p.state, p.movers(), p.never);
    };
    const ExpectedOrder first = expected();
    EXPECT_FALSE(first.cut_off);
    EXPECT_EQ(expected().robots, first.robots);
    const PriorityOrder movers = Planning(problem, options).movers();
    EXPECT_TRUE(std::is_permutation(first.robots.begin(), first.robots.end(), movers.begin(), movers.end()));
    if (first.robots != movers) ++changed;
  }
  EXPECT_GT(changed, 100);
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
