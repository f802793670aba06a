#include "core/travel/travel_times.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <utility>

#include "core/geometry/segment.h"
#include "core/runtime/executor.h"
#include "tests/core/support/planning.h"

namespace fleetplan::core {
namespace TEST_FILE {

using support::robot_at;

constexpr double kPi = std::numbers::pi;

Problem alone(OccupancyGrid grid, std::vector<Robot> robots, std::vector<Zone> zones = {}) {
  ProblemConditions conditions;
  conditions.zones = std::move(zones);
  conditions.one_at_a_time = true;
  return support::make_problem(std::move(grid), std::move(robots), std::move(conditions));
}

/// From the start of every robot to every goal.
TravelAnswers ways(const Problem& problem, const std::vector<Goal>& goals, const PlanOptions& options = {},
                   bool any_heading = false) {
  CallerThread executor;
  TravelQuestions questions;
  questions.any_heading.resize(problem.robots().size(), any_heading);
  std::vector<std::size_t> all;
  for (std::size_t k = 0; k < problem.robots().size(); ++k) all.push_back(k);
  for (const Goal& goal : goals) questions.columns.push_back({goal, all});
  return *travel_times(problem, options, questions, StopCondition::never(), executor, {});
}

std::optional<Travel> way(const Problem& problem, const Goal& goal, const PlanOptions& options = {},
                          bool any_heading = false) {
  return ways(problem, {goal}, options, any_heading)[0][0];
}

Zone rectangle(Zone::Type type, double left, double bottom, double right, double top) {
  Zone zone;
  zone.type = type;
  zone.polygon = {{left, bottom}, {right, bottom}, {right, top}, {left, top}};
  return zone;
}

TEST(TravelTimes, AreRotationsAndAStraightLineInTheOpen) {
  const Problem problem = alone(OccupancyGrid(10, 10, 1.0), {robot_at(1.5, 1.5).speeds(2.0, 1.0)});
  const auto found = way(problem, {Position(5.5, 4.5), kPi / 2});
  EXPECT_NEAR(found->seconds, 5.0 / 2.0 + kPi / 2, 1e-12);
  EXPECT_NEAR(found->metres, 5.0, 1e-12);
}

TEST(TravelTimes, LeaveOutTheRotationsOfPosesWithoutHeading) {
  const Problem problem = alone(OccupancyGrid(10, 10, 1.0), {robot_at(1.5, 1.5, 3.0)});
  const auto found = way(problem, {Position(5.5, 4.5), std::nullopt}, {}, true);
  EXPECT_NEAR(found->seconds, 5.0, 1e-12);
}

TEST(TravelTimes, OfOnePlaceAreARotationAtMost) {
  const Problem problem = alone(OccupancyGrid(4, 4, 1.0), {robot_at(1.2, 1.7, 1.0).speeds(1.0, 0.5)});
  EXPECT_NEAR(way(problem, {Position(1.2, 1.7), 2.0})->seconds, 2.0, 1e-12);
  EXPECT_EQ(way(problem, {Position(1.2, 1.7), std::nullopt})->seconds, 0.0);
  EXPECT_EQ(way(problem, {Position(1.2, 1.7), 2.0}, {}, true)->seconds, 0.0);
  EXPECT_EQ(way(problem, {Position(1.2, 1.7), 2.0})->metres, 0.0);
}

TEST(TravelTimes, AreNoneWhereThereIsNoWay) {
  const Problem problem = alone(support::ascii_map({"...#...", "...#..."}), {robot_at(0.5, 0.5)});
  EXPECT_FALSE(way(problem, {Position(5.5, 0.5), std::nullopt}));
  EXPECT_FALSE(way(problem, {Position(2.9, 0.5), std::nullopt})) << "its disk does not fit";
  EXPECT_TRUE(way(problem, {Position(2.5, 0.5), std::nullopt}));
}

TEST(TravelTimes, KeepToOneWayZones) {
  Zone east = rectangle(Zone::Type::one_way, 2.0, 0.0, 4.0, 1.0);
  east.heading = 0.0;
  east.half_angle = 0.5;
  const Problem problem =
      alone(support::ascii_map({"......"}), {robot_at(0.5, 0.5), robot_at(5.5, 0.5)}, {east});
  const TravelAnswers found =
      ways(problem, {{Position(5.5, 0.5), std::nullopt}, {Position(0.5, 0.5), std::nullopt}});
  EXPECT_NEAR(found[0][0]->seconds, 5.0, 1e-12);
  EXPECT_FALSE(found[1][1]);
}

TEST(TravelTimes, AreThoseOfSlowZonesOrOfTheWayRound) {
  Zone slow = rectangle(Zone::Type::speed, 3.0, 0.0, 7.0, 3.0);
  slow.linear_speed = 0.5;
  const Problem problem = alone(OccupancyGrid(10, 3, 1.0), {robot_at(0.5, 1.5)}, {slow});
  EXPECT_NEAR(way(problem, {Position(9.5, 1.5), std::nullopt})->seconds, 9.0 + 4.0, 1e-9);
  slow.linear_speed = 0.01;
  const Problem open = alone(OccupancyGrid(10, 9, 1.0), {robot_at(0.5, 1.5)}, {slow});
  const auto round = way(open, {Position(9.5, 1.5), std::nullopt});
  EXPECT_LT(round->seconds, 20.0);
  EXPECT_GT(round->metres, 9.5);
}

TEST(TravelTimes, LeadOutOfClosedZonesAndNotIn) {
  Zone closed = rectangle(Zone::Type::blocked, 0.0, 0.0, 3.0, 3.0);
  closed.may_leave = true;
  const Problem problem =
      alone(OccupancyGrid(8, 3, 1.0), {robot_at(1.5, 1.5).to(6.5, 1.5), robot_at(6.5, 1.5)}, {closed});
  const TravelAnswers found =
      ways(problem, {{Position(6.5, 1.5), std::nullopt}, {Position(1.5, 1.5), std::nullopt}});
  EXPECT_NEAR(found[0][0]->seconds, 5.0, 1e-6);
  EXPECT_FALSE(found[1][1]);
}

TEST(TravelTimes, ReverseWhereThatIsFaster) {
  Robot robot = robot_at(5.5, 0.5).speeds(1.0, 1.0);
  const Goal behind{Position(1.5, 0.5), 0.0};
  EXPECT_NEAR(way(alone(OccupancyGrid(8, 1, 1.0), {robot}), behind)->seconds, 4.0 + 2 * kPi, 1e-12);
  robot.may_reverse = true;
  EXPECT_NEAR(way(alone(OccupancyGrid(8, 1, 1.0), {robot}), behind)->seconds, 4.0, 1e-12);
}

TEST(TravelTimes, IncludeTheAddedWaitOfEachMove) {
  PlanOptions options;
  options.wait_before_move = 1.5;
  const Problem problem =
      alone(support::ascii_map({".....", "..#..", "..#.."}), {robot_at(1.5, 0.5, kPi / 2).radius(0.5)});
  const Goal goal{Position(3.5, 0.5), std::nullopt};
  EXPECT_NEAR(way(problem, goal, options)->seconds - way(problem, goal)->seconds, 3 * 1.5, 1e-9);
}

TEST(TravelTimes, OfAPairDoNotDependOnTheOthers) {
  const Problem many =
      alone(maze(), {robot_at(0.5, 0.5), robot_at(20.3, 5.6), robot_at(14.5, 8.5), robot_at(3.5, 7.7)});
  const std::vector<Goal> goals{
      {Position(27.3, 8.4), 1.0}, {Position(11.1, 3.5), std::nullopt}, {Position(0.5, 8.5), 0.0}};
  const TravelAnswers all = ways(many, goals);
  for (std::size_t k = 0; k < goals.size(); ++k) {
    for (std::size_t robot = 0; robot < many.robots().size(); ++robot) {
      const auto one = way(alone(maze(), {many.robots()[robot]}), goals[k]);
      EXPECT_EQ(all[k][robot]->seconds, one->seconds);
      EXPECT_EQ(all[k][robot]->metres, one->metres);
    }
  }
}

TEST(TravelTimes, EndWithTheStopOrTheTurn) {
  const Problem problem = alone(OccupancyGrid(4, 4, 1.0), {robot_at(1.5, 1.5)});
  CallerThread executor;
  const TravelQuestions questions{{false}, {{{Position(2.5, 2.5), std::nullopt}, {0}}}};
  EXPECT_FALSE(travel_times(problem, {}, questions, met(), executor, {}));
  const StopCondition unmet(StopCondition::Clock::time_point::max());
  EXPECT_TRUE(travel_times(problem, {}, questions, unmet, executor, [] { return true; }));
  EXPECT_FALSE(travel_times(problem, {}, questions, unmet, executor, [] { return false; }));
}

using support::make_problem;
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
