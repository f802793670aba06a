#include "core/moves/timed_step_search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/moves/joint_steps.h"
#include "core/moves/place_steps.h"
#include "core/moves/step_places.h"
#include "core/moves/step_times.h"
#include "tests/core/support/planning.h"
#include "tests/support/mazes.h"
#include "tests/support/random_problem.h"
#include "tests/support/sanitized.h"

namespace fleetplan::core {
namespace TEST_FILE {

using support::Cells;
using support::robot_at;

constexpr double kPhase = 5.0;  // seconds: time for a turn and a move of one robot
constexpr double kHop = 1.0;    // seconds, at the end of each phase
constexpr int kPhases = 12;

/// An obstacle that hops from cell to cell, one in each phase, and leaves in the end.
struct Hopping {
  Cells cells;  // by phase; the one of the next phase, where it goes at the end, included

  bool is_at(int phase, int cell) const {
    const auto k = static_cast<std::size_t>(phase);
    return cells[k] == cell || cells[k + 1] == cell;
  }
  MovingObstacle obstacle() const {
    MovingObstacle obstacle;
    obstacle.radius = 0.3;
    obstacle.after = MovingObstacle::After::leaves;
    for (int phase = 0; phase < kPhases; ++phase) {
      const Position here = support::middle_of(cells[static_cast<std::size_t>(phase)]);
      obstacle.motion.push_back({kPhase * phase, here});
      obstacle.motion.push_back({kPhase * (phase + 1) - kHop, here});
    }
    obstacle.motion.push_back({kPhase * kPhases, support::middle_of(cells.back())});
    return obstacle;
  }
};

bool is_free(const support::Maze& maze, int cell) {
  const int row = support::kMazeHeight - 1 - cell / support::kMazeWidth;
  return maze.rows[static_cast<std::size_t>(row)][static_cast<std::size_t>(cell % support::kMazeWidth)] ==
         '.';
}

Hopping random_hops(support::Dice& dice, const support::Maze& maze) {
  Cells free;
  for (int cell = 0; cell < support::kMazeWidth * support::kMazeHeight; ++cell) {
    const bool is_start = std::find(maze.starts.begin(), maze.starts.end(), cell) != maze.starts.end();
    if (is_free(maze, cell) && !is_start) free.push_back(cell);
  }
  Hopping hopping;
  hopping.cells.push_back(free[static_cast<std::size_t>(dice.below(static_cast<int>(free.size())))]);
  for (int phase = 0; phase < kPhases; ++phase) {
    const Cells around = support::cells_beside(hopping.cells.back());
    const int next = around[static_cast<std::size_t>(dice.below(static_cast<int>(around.size())))];
    hopping.cells.push_back(is_free(maze, next) ? next : hopping.cells.back());
  }
  return hopping;
}

/// Whether moves of one robot at a time, at most one in each phase, lead to the goals. They must touch
/// neither the obstacle nor where it goes in the phase. An independent implementation.
bool can_arrive(const support::Maze& maze, const Hopping& hopping) {
  const auto after_a_move = [&](const Cells& at) {
    std::vector<Cells> all;
    for (std::size_t k = 0; k < at.size(); ++k) {
      for (const int to : support::cells_beside(at[k])) {
        if (!is_free(maze, to) || std::find(at.begin(), at.end(), to) != at.end()) continue;
        all.push_back(at);
        all.back()[k] = to;
      }
    }
    return all;
  };
  std::set<Cells> now{maze.starts};
  for (int phase = 0; phase < kPhases; ++phase) {
    const auto is_clear = [&](const Cells& at) {
      return std::none_of(at.begin(), at.end(), [&](int cell) { return hopping.is_at(phase, cell); });
    };
    std::set<Cells> next;
    for (const Cells& at : now) {
      if (!is_clear(at)) continue;
      next.insert(at);
      for (const Cells& moved : after_a_move(at)) {
        if (is_clear(moved)) next.insert(moved);
      }
    }
    now = std::move(next);
  }
  std::vector<Cells> open(now.begin(), now.end());
  while (!open.empty()) {
    const Cells at = open.back();
    open.pop_back();
    if (at == maze.goals) return true;
    for (const Cells& moved : after_a_move(at)) {
      if (now.insert(moved).second) open.push_back(moved);
    }
  }
  return false;
}

TEST(TimedStepSearch, FindsTimesWhereverAnObstacleLeavesThem) {
  int solved = 0;
  int only_with_times = 0;
  for (std::uint64_t seed = 0; seed < (support::kSanitized ? 20U : 60U); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    support::Dice dice(seed);
    const support::Maze maze = support::solvable_maze(dice, 2 + seed % 2, seed % 4 < 2);
    const Hopping hopping = random_hops(dice, maze);
    PlanOptions options;
    options.lattice_spacing = 1.0;
    if (dice.chance(0.3)) options.interval_margin = 0.3;
    Planning p(support::make_problem(support::map_of(maze, 1), support::robots_of(maze),
                                     {.obstacles = {hopping.obstacle()}}),
               options);
    PlaceSteps steps(p.reservations, p.movers(), p.random);
    auto trajectories = steps.run(p.never);
    EXPECT_FALSE(steps.has_no_way()) << "the maze has one";
    if (can_arrive(maze, hopping)) {
      ++solved;
      EXPECT_TRUE(trajectories);
    }
    if (!trajectories) continue;
    for (std::size_t k = 0; k < trajectories->size(); ++k) {
      EXPECT_TRUE(p.reservations.conflicting_robots(k, (*trajectories)[k]).empty());
      p.reservations.follow(k, std::move((*trajectories)[k]));
    }
    support::expect_safe(p.reservations);
    const auto places = places_of_steps(p.reservations, {0, 1}, 0.0, p.never);
    if (maze.starts.size() == 2 && places) {
      const JointSteps joint(*places);
      SingleMoveSearch search(joint);
      ASSERT_EQ(search.run(100'000, p.never), SingleMoveSearch::Outcome::found);
      if (!times_of_steps(p.reservations, {0, 1}, joint, {search.plan()}, p.never)) ++only_with_times;
    }
  }
  EXPECT_GT(solved, support::kSanitized ? 8 : 30);
  EXPECT_GT(only_with_times, support::kSanitized ? 0 : 3);
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
