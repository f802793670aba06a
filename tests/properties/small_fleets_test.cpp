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
    Maze maze{{}, starts, after_random_steps(dice, is_free, starts)};
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

Problem problem_of(const Maze& maze) {
  const auto middle = [](int index) { return index + 0.5; };
  std::vector<Robot> robots;
  for (std::size_t i = 0; i < maze.starts.size(); ++i) {
    robots.push_back(robot_at(middle(maze.starts[i] % kWidth), middle(maze.starts[i] / kWidth))
                         .to(middle(maze.goals[i] % kWidth), middle(maze.goals[i] / kWidth)));
  }
  return support::make_problem(support::ascii_map(maze.rows), std::move(robots));
}

class SmallFleet : public testing::TestWithParam<int> {};

TEST_P(SmallFleet, IsPlannedInEveryMazeThatStepsSolve) {
  support::Dice dice(static_cast<std::uint64_t>(GetParam()));
  for (std::size_t robots = 2; robots <= 6; ++robots) {
    const Maze maze = solvable_maze(dice, robots, GetParam() % 2 == 1);
    std::string drawn;
    for (const std::string& row : maze.rows) drawn += "\n" + row;
    SCOPED_TRACE(testing::Message() << "seed " << GetParam() << ", " << robots << " robots" << drawn);
    EXPECT_TRUE(support::plan_checked(problem_of(maze)).unplanned.empty());
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, SmallFleet, testing::Range(0, 60));

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
