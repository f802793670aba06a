// Small fleets where there is hardly room to pass: every maze that single steps, one robot at a time, solve
// is solved, and so is every corridor in which two robots fit beside each other.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "tests/support/ascii_map.h"
#include "tests/support/plan_checked.h"
#include "tests/support/problem_builder.h"
#include "tests/support/random_problem.h"

namespace fleetplan::core {
namespace TEST_FILE {

using support::robot_at;

constexpr int kWidth = 5;
constexpr int kHeight = 5;
constexpr int kCells = kWidth * kHeight;

using Cells = std::vector<int>;  // numbers of cells, row by row

std::vector<int> neighbours(int cell) {
  std::vector<int> all;
  const int column = cell % kWidth;
  const int row = cell / kWidth;
  if (column > 0) all.push_back(cell - 1);
  if (column + 1 < kWidth) all.push_back(cell + 1);
  if (row > 0) all.push_back(cell - kWidth);
  if (row + 1 < kHeight) all.push_back(cell + kWidth);
  return all;
}

/// A maze of corridors of one cell. With `cycles`, some of its walls are open.
std::vector<bool> random_maze(support::Dice& dice, bool cycles) {
  std::vector<bool> is_free(kCells, false);
  is_free[static_cast<std::size_t>(dice.below(kCells))] = true;
  for (int k = 0; k < 300; ++k) {
    const int cell = dice.below(kCells);
    const std::vector<int> around = neighbours(cell);
    const auto open = std::count_if(around.begin(), around.end(),
                                    [&](int other) { return is_free[static_cast<std::size_t>(other)]; });
    const bool closes_cycle = cycles && open == 2 && dice.below(4) == 0;
    if (open == 1 || closes_cycle) is_free[static_cast<std::size_t>(cell)] = true;
  }
  return is_free;
}

/// Where robots are after many random steps, one robot at a time: steps lead there, and back.
Cells after_random_steps(support::Dice& dice, const std::vector<bool>& is_free, Cells robots) {
  constexpr int kSteps = 3000;
  for (int k = 0; k < kSteps; ++k) {
    int& robot = robots[static_cast<std::size_t>(dice.below(static_cast<int>(robots.size())))];
    const std::vector<int> around = neighbours(robot);
    const int to = around[static_cast<std::size_t>(dice.below(static_cast<int>(around.size())))];
    const bool is_taken = std::find(robots.begin(), robots.end(), to) != robots.end();
    if (!is_taken && is_free[static_cast<std::size_t>(to)]) robot = to;
  }
  return robots;
}

struct Maze {
  std::vector<std::string> rows;
  Cells starts;
  Cells on_the_way;  // where the robots are, all at once, between starts and goals
  Cells goals;
};

/// A random maze that steps solve, with robots in it.
Maze solvable_maze(support::Dice& dice, std::size_t robots, bool cycles) {
  for (;;) {
    const std::vector<bool> is_free = random_maze(dice, cycles);
    Cells cells;
    for (int cell = 0; cell < kCells; ++cell) {
      if (is_free[static_cast<std::size_t>(cell)]) cells.push_back(cell);
    }
    if (cells.size() < robots + 2) continue;
    Cells starts = cells;
    for (std::size_t k = 0; k < robots; ++k) {
      const int left = static_cast<int>(starts.size() - k);
      std::swap(starts[k], starts[k + static_cast<std::size_t>(dice.below(left))]);
    }
    starts.resize(robots);
    const Cells on_the_way = after_random_steps(dice, is_free, starts);
    Maze maze{{}, starts, on_the_way, after_random_steps(dice, is_free, on_the_way)};
    for (int row = kHeight - 1; row >= 0; --row) {
      std::string line;
      for (int column = 0; column < kWidth; ++column) {
        line += is_free[static_cast<std::size_t>(row * kWidth + column)] ? '.' : '#';
      }
      maze.rows.push_back(line);
    }
    return maze;
  }
}

Position middle_of(int cell) { return {cell % kWidth + 0.5, cell / kWidth + 0.5}; }

/// The robots of a maze, on cells of 1 m.
std::vector<Robot> robots_of(const Maze& maze) {
  std::vector<Robot> robots;
  for (std::size_t i = 0; i < maze.starts.size(); ++i) {
    const Position start = middle_of(maze.starts[i]);
    const Position goal = middle_of(maze.goals[i]);
    robots.push_back(robot_at(start.x(), start.y()).to(goal.x(), goal.y()));
  }
  return robots;
}

/// Its map, each cell divided into so many rows and columns.
OccupancyGrid map_of(const Maze& maze, int divided_by) {
  std::vector<std::string> rows;
  for (const std::string& row : maze.rows) {
    std::string finer;
    for (const char cell : row) finer += std::string(static_cast<std::size_t>(divided_by), cell);
    rows.insert(rows.end(), static_cast<std::size_t>(divided_by), finer);
  }
  const OccupancyGrid unit = support::ascii_map(rows);
  OccupancyGrid grid(unit.columns(), unit.rows(), 1.0 / divided_by);
  for (int row = 0; row < unit.rows(); ++row) {
    for (int column = 0; column < unit.columns(); ++column) {
      if (unit.blocked({column, row})) grid.block({column, row});
    }
  }
  return grid;
}

std::string drawing_of(const Maze& maze) {
  std::string drawn;
  for (const std::string& row : maze.rows) drawn += "\n" + row;
  return drawn;
}

class SmallFleet : public testing::TestWithParam<int> {};

TEST_P(SmallFleet, IsPlannedInEveryMazeThatStepsSolve) {
  support::Dice dice(static_cast<std::uint64_t>(GetParam()));
  for (std::size_t robots = 2; robots <= 6; ++robots) {
    const Maze maze = solvable_maze(dice, robots, GetParam() % 2 == 1);
    SCOPED_TRACE(testing::Message() << "seed " << GetParam() << ", " << robots << " robots"
                                    << drawing_of(maze));
    const Problem problem = support::make_problem(map_of(maze, 1), robots_of(maze));
    EXPECT_TRUE(support::plan_checked(problem).unplanned.empty());
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, SmallFleet, testing::Range(0, 60));

/// What robots and requests may have, one kind at a time.
struct Member {
  const char* name;
  void (*add)(const Maze&, support::Dice&, std::vector<Robot>&, ProblemConditions&, PlanOptions&);
};

const std::vector<Member>& members() {
  using Robots = std::vector<Robot>;
  using Dice = support::Dice;
  static const std::vector<Member> all{
      {"nothing", [](const Maze&, Dice&, Robots&, ProblemConditions&, PlanOptions&) {}},
      {"starts 5 cm off",
       [](const Maze&, Dice& dice, Robots& robots, ProblemConditions&, PlanOptions&) {
         for (Robot& robot : robots) robot.start.position.x() += dice.chance(0.5) ? 0.05 : -0.05;
       }},
      {"an obstacle far away",
       [](const Maze&, Dice&, Robots&, ProblemConditions& conditions, PlanOptions&) {
         MovingObstacle obstacle;
         obstacle.radius = 0.2;
         obstacle.motion = {{100.0, {-5.0, -5.0}}, {110.0, {-5.0, -4.0}}};
         conditions.obstacles.push_back(obstacle);
       }},
      {"a margin", [](const Maze&, Dice&, Robots&, ProblemConditions&,
                      PlanOptions& options) { options.interval_margin = 0.3; }},
      {"inflation and a wait",
       [](const Maze&, Dice&, Robots&, ProblemConditions&, PlanOptions& options) {
         options.inflation = 0.05;
         options.wait_before_move = 0.2;
       }},
      {"a commitment",
       [](const Maze&, Dice&, Robots& robots, ProblemConditions&, PlanOptions&) {
         Robot& robot = robots.front();
         const Pose turned{robot.start.position, 1.5};
         robot.committed = {{Action::Type::rotate, 0.0, 1.5, robot.start, turned},
                            {Action::Type::wait, 1.5, 3.0, turned, turned}};
       }},
      {"two goals",
       [](const Maze& maze, Dice&, Robots& robots, ProblemConditions&, PlanOptions&) {
         for (std::size_t i = 0; i < robots.size(); ++i) {
           robots[i].via.push_back({middle_of(maze.on_the_way[i]), 1.0, 2.0});
         }
       }},
      {"loads",
       [](const Maze& maze, Dice&, Robots& robots, ProblemConditions&, PlanOptions&) {
         for (std::size_t i = 0; i < robots.size(); ++i) {
           robots[i].radius = 0.3;
           robots[i].via.push_back({middle_of(maze.on_the_way[i]), std::nullopt});
           robots[i].via.back().radius_after = 0.45;
         }
       }},
      {"radii",
       [](const Maze&, Dice& dice, Robots& robots, ProblemConditions&, PlanOptions&) {
         for (Robot& robot : robots) robot.radius = dice.between(0.3, 0.45);
       }},
      {"accelerations",
       [](const Maze&, Dice&, Robots& robots, ProblemConditions&, PlanOptions&) {
         for (Robot& robot : robots) robot.linear_acceleration = robot.linear_deceleration = 0.5;
       }},
      {"driving backwards",
       [](const Maze&, Dice&, Robots& robots, ProblemConditions&, PlanOptions&) {
         for (Robot& robot : robots) robot.may_reverse = true;
       }},
      {"a vicinity",
       [](const Maze&, Dice&, Robots& robots, ProblemConditions&, PlanOptions&) {
         for (Robot& robot : robots) robot.vicinity = 0.05;
       }},
      {"an idle robot", [](const Maze&, Dice&, Robots& robots, ProblemConditions&, PlanOptions&) {
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
    const Maze maze = solvable_maze(dice, 2 + seed % 3, seed % 2 == 1);
    std::vector<Robot> robots = robots_of(maze);
    ProblemConditions conditions;
    PlanOptions options;
    member.add(maze, dice, robots, conditions, options);
    SCOPED_TRACE(testing::Message() << member.name << ", seed " << seed << drawing_of(maze));
    const Problem problem = support::make_problem(map_of(maze, 20), std::move(robots), std::move(conditions));
    EXPECT_TRUE(support::plan_checked(problem, options).unplanned.empty());
  }
}

INSTANTIATE_TEST_SUITE_P(Members, SmallFleetWith, testing::Range<std::size_t>(0, 13));

/// A corridor with two robots at its ends, each on its way to the other end.
struct Corridor {
  double radius;      // metres
  double radii_wide;  // about: the width is that of so many cells
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
