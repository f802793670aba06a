#pragma once

// Mazes of corridors for one robot, with robots in them that can get to their goals, one robot at a time.

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "core/map/occupancy_grid.h"
#include "core/model/robot.h"
#include "tests/support/ascii_map.h"
#include "tests/support/problem_builder.h"
#include "tests/support/random_problem.h"

namespace fleetplan::support {

inline constexpr int kMazeWidth = 5;
inline constexpr int kMazeHeight = 5;

using Cells = std::vector<int>;  // numbers of cells, row by row

inline std::vector<int> cells_beside(int cell) {
  std::vector<int> all;
  const int column = cell % kMazeWidth;
  const int row = cell / kMazeWidth;
  if (column > 0) all.push_back(cell - 1);
  if (column + 1 < kMazeWidth) all.push_back(cell + 1);
  if (row > 0) all.push_back(cell - kMazeWidth);
  if (row + 1 < kMazeHeight) all.push_back(cell + kMazeWidth);
  return all;
}

/// A maze of corridors of one cell. With `cycles`, some of its walls are open.
inline std::vector<bool> random_maze(Dice& dice, bool cycles) {
  std::vector<bool> is_free(kMazeWidth * kMazeHeight, false);
  is_free[static_cast<std::size_t>(dice.below(kMazeWidth * kMazeHeight))] = true;
  for (int k = 0; k < 300; ++k) {
    const int cell = dice.below(kMazeWidth * kMazeHeight);
    const std::vector<int> around = cells_beside(cell);
    const auto open = std::count_if(around.begin(), around.end(),
                                    [&](int other) { return is_free[static_cast<std::size_t>(other)]; });
    const bool closes_cycle = cycles && open == 2 && dice.below(4) == 0;
    if (open == 1 || closes_cycle) is_free[static_cast<std::size_t>(cell)] = true;
  }
  return is_free;
}

/// Where robots are after many random steps, one robot at a time: steps lead there, and back.
inline Cells after_random_steps(Dice& dice, const std::vector<bool>& is_free, Cells robots) {
  constexpr int kSteps = 3000;
  for (int k = 0; k < kSteps; ++k) {
    int& robot = robots[static_cast<std::size_t>(dice.below(static_cast<int>(robots.size())))];
    const std::vector<int> around = cells_beside(robot);
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
inline Maze solvable_maze(Dice& dice, std::size_t robots, bool cycles) {
  for (;;) {
    const std::vector<bool> is_free = random_maze(dice, cycles);
    Cells cells;
    for (int cell = 0; cell < kMazeWidth * kMazeHeight; ++cell) {
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
    for (int row = kMazeHeight - 1; row >= 0; --row) {
      std::string line;
      for (int column = 0; column < kMazeWidth; ++column) {
        line += is_free[static_cast<std::size_t>(row * kMazeWidth + column)] ? '.' : '#';
      }
      maze.rows.push_back(line);
    }
    return maze;
  }
}

inline core::Position middle_of(int cell) { return {cell % kMazeWidth + 0.5, cell / kMazeWidth + 0.5}; }

/// The robots of a maze, on cells of 1 m.
inline std::vector<core::Robot> robots_of(const Maze& maze) {
  std::vector<core::Robot> robots;
  for (std::size_t i = 0; i < maze.starts.size(); ++i) {
    const core::Position start = middle_of(maze.starts[i]);
    const core::Position goal = middle_of(maze.goals[i]);
    robots.push_back(robot_at(start.x(), start.y()).to(goal.x(), goal.y()));
  }
  return robots;
}

/// Its map, each cell divided into so many rows and columns.
inline core::OccupancyGrid map_of(const Maze& maze, int divided_by) {
  std::vector<std::string> rows;
  for (const std::string& row : maze.rows) {
    std::string finer;
    for (const char cell : row) finer += std::string(static_cast<std::size_t>(divided_by), cell);
    rows.insert(rows.end(), static_cast<std::size_t>(divided_by), finer);
  }
  const core::OccupancyGrid unit = ascii_map(rows);
  core::OccupancyGrid grid(unit.columns(), unit.rows(), 1.0 / divided_by);
  for (int row = 0; row < unit.rows(); ++row) {
    for (int column = 0; column < unit.columns(); ++column) {
      if (unit.blocked({column, row})) grid.block({column, row});
    }
  }
  return grid;
}

inline std::string drawing_of(const Maze& maze) {
  std::string drawn;
  for (const std::string& row : maze.rows) drawn += "\n" + row;
  return drawn;
}

}  // namespace fleetplan::support
