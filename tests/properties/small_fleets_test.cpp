// Small fleets with hardly any room to pass. Every maze that single steps, one robot at a time, solve is
// solved. So is every corridor in which two robots fit beside each other.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "tests/support/mazes.h"
#include "tests/support/plan_checked.h"
#include "tests/support/problem_builder.h"
#include "tests/support/random_problem.h"

namespace fleetplan::core {
namespace TEST_FILE {

using support::robot_at;

class SmallFleet : public testing::TestWithParam<int> {};

TEST_P(SmallFleet, IsPlannedInEveryMazeThatStepsSolve) {
  support::Dice dice(static_cast<std::uint64_t>(GetParam()));
  for (std::size_t robots = 2; robots <= 6; ++robots) {
    const support::Maze maze = support::solvable_maze(dice, robots, GetParam() % 2 == 1);
    SCOPED_TRACE(testing::Message() << "seed " << GetParam() << ", " << robots << " robots"
                                    << support::drawing_of(maze));
    const Problem problem = support::make_problem(support::map_of(maze, 1), support::robots_of(maze));
    EXPECT_TRUE(support::plan_checked(problem).unplanned.empty());
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, SmallFleet, testing::Range(0, 60));

/// What robots and requests may have, one kind at a time.
struct Member {
  const char* name;
  void (*add)(const support::Maze&, support::Dice&, std::vector<Robot>&, ProblemConditions&, PlanOptions&);
};

const std::vector<Member>& members() {
  using Robots = std::vector<Robot>;
  using Dice = support::Dice;
  static const std::vector<Member> all{
      {"nothing", [](const support::Maze&, Dice&, Robots&, ProblemConditions&, PlanOptions&) {}},
      {"starts 5 cm off",
       [](const support::Maze&, Dice& dice, Robots& robots, ProblemConditions&, PlanOptions&) {
         for (Robot& robot : robots) robot.start.position.x() += dice.chance(0.5) ? 0.05 : -0.05;
       }},
      {"an obstacle far away",
       [](const support::Maze&, Dice&, Robots&, ProblemConditions& conditions, PlanOptions&) {
         MovingObstacle obstacle;
         obstacle.radius = 0.2;
         obstacle.motion = {{100.0, {-5.0, -5.0}}, {110.0, {-5.0, -4.0}}};
         conditions.obstacles.push_back(obstacle);
       }},
      {"a margin", [](const support::Maze&, Dice&, Robots&, ProblemConditions&,
                      PlanOptions& options) { options.interval_margin = 0.3; }},
      {"inflation and a wait",
       [](const support::Maze&, Dice&, Robots&, ProblemConditions&, PlanOptions& options) {
         options.inflation = 0.05;
         options.wait_before_move = 0.2;
       }},
      {"a commitment",
       [](const support::Maze&, Dice&, Robots& robots, ProblemConditions&, PlanOptions&) {
         Robot& robot = robots.front();
         const Pose turned{robot.start.position, 1.5};
         robot.committed = {{Action::Type::rotate, 0.0, 1.5, robot.start, turned},
                            {Action::Type::wait, 1.5, 3.0, turned, turned}};
       }},
      {"two goals",
       [](const support::Maze& maze, Dice&, Robots& robots, ProblemConditions&, PlanOptions&) {
         for (std::size_t i = 0; i < robots.size(); ++i) {
           robots[i].via.push_back({support::middle_of(maze.on_the_way[i]), 1.0, 2.0});
         }
       }},
      {"loads",
       [](const support::Maze& maze, Dice&, Robots& robots, ProblemConditions&, PlanOptions&) {
         for (std::size_t i = 0; i < robots.size(); ++i) {
           robots[i].radius = 0.3;
           robots[i].via.push_back({support::middle_of(maze.on_the_way[i]), std::nullopt});
           robots[i].via.back().radius_after = 0.45;
         }
       }},
      {"radii",
       [](const support::Maze&, Dice& dice, Robots& robots, ProblemConditions&, PlanOptions&) {
         for (Robot& robot : robots) robot.radius = dice.between(0.3, 0.45);
       }},
      {"accelerations",
       [](const support::Maze&, Dice&, Robots& robots, ProblemConditions&, PlanOptions&) {
         for (Robot& robot : robots) robot.linear_acceleration = robot.linear_deceleration = 0.5;
       }},
      {"driving backwards",
       [](const support::Maze&, Dice&, Robots& robots, ProblemConditions&, PlanOptions&) {
         for (Robot& robot : robots) robot.may_reverse = true;
       }},
      {"a vicinity",
       [](const support::Maze&, Dice&, Robots& robots, ProblemConditions&, PlanOptions&) {
         for (Robot& robot : robots) robot.vicinity = 0.05;
       }},
      {"an idle robot", [](const support::Maze&, Dice&, Robots& robots, ProblemConditions&, PlanOptions&) {
         robots.front().goal.reset();
         robots.front().let_yield();
       }}};
  return all;
}

class SmallFleetWith : public testing::TestWithParam<std::size_t> {};

TEST_P(SmallFleetWith, IsPlannedOnCellsOfFiveCentimetres) {
  const Member& member = members()[GetParam()];
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    support::Dice dice(1000 * (1 + GetParam()) + seed);
    const support::Maze maze = support::solvable_maze(dice, 2 + seed % 3, seed % 2 == 1);
    std::vector<Robot> robots = support::robots_of(maze);
    ProblemConditions conditions;
    PlanOptions options;
    member.add(maze, dice, robots, conditions, options);
    SCOPED_TRACE(testing::Message() << member.name << ", seed " << seed << support::drawing_of(maze));
    const Problem problem =
        support::make_problem(support::map_of(maze, 20), std::move(robots), std::move(conditions));
    EXPECT_TRUE(support::plan_checked(problem, options).unplanned.empty());
  }
}

INSTANTIATE_TEST_SUITE_P(Members, SmallFleetWith, testing::Range<std::size_t>(0, 13));

/// A corridor with two robots at its ends, each on its way to the other end.
struct Corridor {
  double radius;      // metres
  double radii_wide;  // about: the width is so many cells
  double resolution;  // metres
  double length;      // metres
  double off_middle;  // metres, of starts and goals
};

class CorridorForTwo : public testing::TestWithParam<Corridor> {};

TEST_P(CorridorForTwo, LetsThemPass) {
  const auto& [radius, radii_wide, resolution, length, off_middle] = GetParam();
  const int rows = static_cast<int>(std::ceil(radii_wide * radius / resolution - 1e-9));
  const OccupancyGrid grid(static_cast<int>(std::lround(length / resolution)), rows, resolution);
  ASSERT_GE(grid.height(), 4.0 * radius) << "no room for both";
  const double y = 0.5 * grid.height() + off_middle;
  const double left = 1.5 * radius;
  const double right = grid.width() - left;
  const Problem problem = support::make_problem(
      grid, {robot_at(left, y).radius(radius).to(right, y), robot_at(right, y).radius(radius).to(left, y)});
  const Plan plan = support::plan_checked(problem);
  EXPECT_TRUE(plan.unplanned.empty());
  EXPECT_LE(plan.objectives.flowtime, 1.25 * plan.lower_bound.flowtime);
}

INSTANTIATE_TEST_SUITE_P(
    Widths, CorridorForTwo,
    testing::Values(Corridor{0.4, 5.0, 0.05, 20.0, 0.0}, Corridor{0.4, 5.0, 1.0, 20.0, 0.0},
                    Corridor{0.7, 4.29, 0.1, 20.0, 0.0}, Corridor{0.4, 4.2, 0.05, 12.0, 0.0},
                    Corridor{0.5, 6.0, 1.0, 12.0, 0.0}, Corridor{0.25, 4.4, 0.1, 8.0, 0.0},
                    Corridor{0.3, 5.0, 0.5, 8.0, 0.0}, Corridor{0.7, 5.5, 0.05, 16.8, 0.1},
                    Corridor{0.4, 5.0, 0.25, 12.0, -0.15}, Corridor{0.5, 4.4, 0.2, 20.0, 0.05}));

TEST(SmallFleets, MayHaveRobotsOfDifferentSizesAndOneThatWaits) {
  // The slow one in the middle of the corridor leaves room only where it moves aside.
  const OccupancyGrid grid(160, 20, 0.1);
  const Problem problem = support::make_problem(
      grid, {robot_at(1.0, 1.0).radius(0.3).to(15.0, 1.0), robot_at(15.0, 1.0).radius(0.6).to(1.0, 1.0),
             robot_at(8.0, 1.0).radius(0.3).speeds(0.2, 1.0).to(7.0, 1.0)});
  EXPECT_TRUE(support::plan_checked(problem).unplanned.empty());
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
