#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>
#include <utility>

#include "core/geometry/segment.h"
#include "core/runtime/executor.h"
#include "core/travel/travel_times.h"
#include "tests/core/support/planning.h"

namespace fleetplan::core {
namespace TEST_FILE {

using support::make_problem;
using support::robot_at;
using testing::DoubleNear;
using testing::ElementsAre;

auto near(double seconds) { return DoubleNear(seconds, 1e-9); }

OccupancyGrid hall() { return {12, 3, 1.0}; }

Goal at(double x, double y) { return {Position(x, y), std::nullopt}; }

Goal served(double x, double y, double service, double not_before = 0.0) {
  return {Position(x, y), std::nullopt, service, not_before};
}

/// All robots may do all of the tasks.
std::vector<std::vector<double>> arrivals_of(const Problem& problem, std::vector<std::vector<Goal>> goals) {
  CallerThread executor;
  std::vector<Task> tasks;
  for (std::vector<Goal>& of_task : goals) {
    Task& task = tasks.emplace_back(Task{std::move(of_task), {}});
    for (std::size_t robot = 0; robot < problem.robots().size(); ++robot) task.robots.push_back(robot);
  }
  return *arrivals(problem, {}, tasks, StopCondition::never(), executor, {});
}

TEST(Arrivals, AreThoseOfTheWaysOfEachRobot) {
  const Problem problem = make_problem(hall(), {robot_at(0.5, 0.5), robot_at(0.5, 2.5).speeds(2.0, 1.0)});
  const auto found = arrivals_of(problem, {{at(6.5, 0.5)}, {at(8.5, 2.5)}});
  EXPECT_THAT(found[0][0], near(6.0));
  EXPECT_THAT(found[1][1], near(4.0));
}

TEST(Arrivals, ComeAfterTheGoalsThatARobotHas) {
  Robot robot = robot_at(0.5, 0.5);
  robot.via = {served(2.5, 0.5, 3.0)};
  robot.goal = served(4.5, 0.5, 2.0, 20.0);
  const auto found = arrivals_of(make_problem(hall(), {robot}), {{at(6.5, 0.5)}});
  EXPECT_THAT(found[0][0], near(20.0 + 2.0 + 2.0));
}

TEST(Arrivals, AreAtTheLastGoalOfATaskBeforeItsService) {
  const Problem problem = make_problem(hall(), {robot_at(0.5, 0.5)});
  const auto found = arrivals_of(problem, {{served(3.5, 0.5, 4.0), served(5.5, 0.5, 100.0)}});
  EXPECT_THAT(found[0][0], near(3.0 + 4.0 + 2.0));
}

TEST(Arrivals, BeginAtTheEndOfWhatIsCommitted) {
  const Problem problem = make_problem(hall(), {robot_at(0.5, 0.5).drives(3.5, 0.5)});
  EXPECT_THAT(arrivals_of(problem, {{at(5.5, 0.5)}})[0][0], near(5.0));
}

TEST(Arrivals, CountTheServiceThatGoesOn) {
  Robot robot = robot_at(0.5, 0.5).drives(3.5, 0.5).waits(5.0);
  robot.goal = served(3.5, 0.5, 6.0);
  const auto found = arrivals_of(make_problem(hall(), {robot}), {{at(5.5, 0.5)}});
  EXPECT_THAT(found[0][0], near(3.0 + 6.0 + 2.0));
}

TEST(Arrivals, AreNeverWhereThereIsNoWay) {
  const Problem problem = make_problem(support::ascii_map({"...#..", "...#.."}), {robot_at(0.5, 0.5)});
  const auto found = arrivals_of(problem, {{at(5.5, 0.5)}, {at(1.5, 0.5), at(5.5, 0.5)}, {at(2.5, 0.5)}});
  EXPECT_EQ(found[0][0], kForever);
  EXPECT_EQ(found[1][0], kForever);
  EXPECT_LT(found[2][0], kForever);
}

TEST(Arrivals, AreThoseOfLargerRobotsAfterALoad) {
  // The gap in the wall is for a robot without a load.
  const OccupancyGrid grid = support::ascii_map({".....", "##.##", ".....", "....."});
  Goal load{Position(1.5, 1.0), std::nullopt};
  load.radius_after = 0.8;
  const Problem problem = make_problem(grid, {robot_at(3.5, 1.0).radius(0.4)});
  const auto found =
      arrivals_of(problem, {{at(1.5, 1.0), at(2.5, 3.5)}, {load, at(2.5, 3.5)}, {load, at(3.5, 1.0)}});
  EXPECT_LT(found[0][0], kForever);
  EXPECT_EQ(found[1][0], kForever);
  EXPECT_LT(found[2][0], kForever);
}

TEST(Arrivals, AreNoneWithoutTasksOrRobotsForThem) {
  CallerThread executor;
  const Problem problem = make_problem(hall(), {robot_at(0.5, 0.5)});
  EXPECT_THAT(arrivals_of(problem, {}), testing::IsEmpty());
  const auto found = arrivals(problem, {}, {{{at(1.5, 0.5)}, {}}}, StopCondition::never(), executor, {});
  EXPECT_THAT(*found, ElementsAre(testing::IsEmpty()));
}

TEST(Arrivals, EndWithTheStop) {
  CallerThread executor;
  const Problem problem = make_problem(hall(), {robot_at(0.5, 0.5)});
  EXPECT_FALSE(arrivals(problem, {}, {{{at(1.5, 0.5)}, {0}}}, met(), executor, {}));
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
