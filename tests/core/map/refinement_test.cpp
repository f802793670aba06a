// Refined lattices connect what a fine lattice connects.

#include "core/map/refinement.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cstdint>
#include <memory>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "core/map/lattice.h"
#include "core/map/static_map.h"
#include "core/runtime/stop_condition.h"
#include "tests/support/ascii_map.h"
#include "tests/support/random_problem.h"
#include "tests/support/step_limit.h"

namespace fleetplan::core {
namespace TEST_FILE {

/// Sets of things that are connected.
class Components {
 public:
  explicit Components(int count) : parents_(static_cast<std::size_t>(count)) {
    std::iota(parents_.begin(), parents_.end(), 0);
  }
  int of(int thing) {
    int& parent = parents_[static_cast<std::size_t>(thing)];
    if (parent != thing) parent = of(parent);
    return parent;
  }
  void join(int a, int b) { parents_[static_cast<std::size_t>(of(a))] = of(b); }

 private:
  std::vector<int> parents_;
};

/// By lattice moves, and by the links of the finer vertices.
Components components(const Lattice& lattice, const LineOfSight& sight, double radius,
                      const FinerVertices& finer) {
  FreeSpace space(lattice, sight, radius);
  Components all(lattice.vertex_count() + finer.count());
  for (int vertex = 0; vertex < lattice.vertex_count(); ++vertex) {
    const std::uint32_t mask = space.steps_from(vertex);
    for (std::size_t k = 0; k < lattice.steps().size(); ++k) {
      const Lattice::Step& step = lattice.steps()[k];
      if ((mask >> k & 1u) != 0) all.join(vertex, vertex + step.rows * lattice.columns() + step.columns);
    }
  }
  for (const auto& [from, to] : finer.links()) all.join(from, to);
  return all;
}

/// Rooms with doors of random widths in their walls, and speckle.
OccupancyGrid building(support::Dice& dice) {
  const int columns = 30 + dice.below(50);
  const int rows = 30 + dice.below(50);
  OccupancyGrid grid(columns, rows, 0.05);
  for (int wall = 0; wall < 6; ++wall) {
    const bool vertical = dice.below(2) == 0;
    const int at = dice.below(vertical ? columns : rows);
    const int length = vertical ? rows : columns;
    const int door = dice.below(length);
    const int width = 5 + dice.below(14);
    for (int k = 0; k < length; ++k) {
      if (k >= door && k < door + width) continue;
      grid.block(vertical ? Cell{at, k} : Cell{k, at});
    }
  }
  for (int k = dice.below(12); k > 0; --k) grid.block({dice.below(columns), dice.below(rows)});
  return grid;
}

Position position_of(const Lattice& lattice, const FinerVertices& finer, int vertex) {
  return vertex < lattice.vertex_count() ? lattice.position(vertex) : finer.position(vertex);
}

TEST(Refinement, ConnectsWhatTheLatticeOfTheCellsConnects) {
  const std::uint64_t seed = 11;
  support::Dice dice(seed);
  int refined = 0;
  for (int map = 0; map < 60; ++map) {
    SCOPED_TRACE(testing::Message() << "seed " << seed << ", map " << map);
    const OccupancyGrid grid = building(dice);
    const LineOfSight sight(grid, StopCondition::never());
    const double radius = dice.between(0.1, 0.45);
    const double spacing = 0.05 * (2 * (1 + dice.below(5)) + 1);
    const Lattice lattice(grid, 4 << dice.below(4), spacing);
    const auto finer = refine(grid, sight, lattice, radius, StopCondition::never());
    ASSERT_TRUE(finer);
    refined += finer->count() > 0 ? 1 : 0;
    const Lattice cells(grid, 8);
    Components fine = components(cells, sight, radius, {});
    Components coarse = components(lattice, sight, radius, *finer);
    // Every vertex of the lattice is a cell; the components of both lattices agree on them.
    std::vector<int> coarse_of(static_cast<std::size_t>(cells.vertex_count()), -1);
    for (int vertex = 0; vertex < lattice.vertex_count() + finer->count(); ++vertex) {
      const Position place = position_of(lattice, *finer, vertex);
      if (!sight.disk_fits(place, radius)) continue;
      const int cell = cells.vertex_at(place);
      ASSERT_GE(cell, 0);
      int& known = coarse_of[static_cast<std::size_t>(fine.of(cell))];
      if (known < 0) known = coarse.of(vertex);
      ASSERT_EQ(known, coarse.of(vertex)) << "vertex " << vertex << " at " << place.transpose();
    }
    for (int cell = 0; cell < cells.vertex_count(); ++cell) {
      if (!sight.disk_fits(cells.position(cell), radius)) continue;
      ASSERT_GE(coarse_of[static_cast<std::size_t>(fine.of(cell))], 0) << "no vertex near cell " << cell;
    }
    for (const auto& [from, to] : finer->links()) {
      ASSERT_TRUE(
          sight.may_sweep(position_of(lattice, *finer, from), position_of(lattice, *finer, to), radius));
    }
  }
  EXPECT_GT(refined, 10) << "the test does not test what it should";
}

TEST(Refinement, FindsTheMiddleOfAGapBetweenCells) {
  const OccupancyGrid grid = support::ascii_map({"....#....",  //
                                                 "....#....",  //
                                                 ".........",  //
                                                 ".........",  //
                                                 "....#....",  //
                                                 "....#...."},
                                                0.5);
  const StaticMap map(grid, StopCondition::never());
  const Lattice lattice(grid, 8);
  const auto finer = map.finer_vertices(lattice, 0.3, StopCondition::never());
  ASSERT_GT(finer->count(), 0);
  Components all = components(lattice, map.sight(), 0.3, *finer);
  EXPECT_EQ(all.of(lattice.vertex(1, 2)), all.of(lattice.vertex(7, 3)));
  EXPECT_EQ(map.finer_vertices(lattice, 0.3, StopCondition::never()), finer) << "computed once";
  EXPECT_EQ(map.finer_vertices(lattice, 0.25, StopCondition::never())->count(), 0)
      << "follows the centres of the cells";
}

TEST(Refinement, AddsNothingWhereTheLatticeHasAWayNearby) {
  const StaticMap map(OccupancyGrid(40, 40, 0.05), StopCondition::never());
  const Lattice lattice(map.grid(), 8, 0.25);
  const auto finer = map.finer_vertices(lattice, 0.3, StopCondition::never());
  EXPECT_EQ(finer->count(), 0);
  EXPECT_TRUE(finer->links().empty());
}

TEST(Refinement, LeavesOutGapsWithoutPlay) {
  const OccupancyGrid grid = support::ascii_map({"...#...",  //
                                                 ".......",  //
                                                 ".......",  //
                                                 "...#..."});
  const StaticMap map(grid, StopCondition::never());
  const Lattice lattice(grid, 8);
  EXPECT_TRUE(map.finer_vertices(lattice, 1.0, StopCondition::never())->links().empty());
}

TEST(Refinement, EndsWhenItIsStopped) {
  StopCondition::Clock::time_point past{};
  const StaticMap map(support::ascii_map({"...#...", ".......", ".......", "...#..."}, 0.5),
                      StopCondition::never());
  const Lattice lattice(map.grid(), 8);
  EXPECT_EQ(map.finer_vertices(lattice, 0.3, StopCondition(past))->count(), 0);
  EXPECT_GT(map.finer_vertices(lattice, 0.3, StopCondition::never())->count(), 0)
      << "what was not finished is not kept";
}

/// How often it asks the stop condition, which is met after `end` questions, and whether it is finished.
std::pair<std::int64_t, bool> questions(const StaticMap& map, const Lattice& lattice, double radius,
                                        std::int64_t end) {
  support::StepLimit limit(end);
  const bool finished = refine(map.grid(), map.sight(), lattice, radius, support::counted(limit)).has_value();
  return {limit.steps(), finished};
}

void expect_to_end_at_every_question(const StaticMap& map, const Lattice& lattice, double radius,
                                     std::int64_t least) {
  const auto [all, finished] = questions(map, lattice, radius, support::StepLimit::kNever);
  EXPECT_TRUE(finished);
  EXPECT_GE(all, least);
  for (std::int64_t end = 0; end < all; end += 1 + all / 50) {
    EXPECT_EQ(questions(map, lattice, radius, end), std::pair(end + 1, false)) << "of " << all;
  }
}

TEST(Refinement, EndsWhenTheStopConditionIsMet) {
  support::Dice dice(5);
  const StaticMap map(building(dice), StopCondition::never());
  for (const double spacing : {1.0, 4.0}) {
    const Lattice lattice(map.grid(), 16, spacing * map.grid().resolution());
    expect_to_end_at_every_question(map, lattice, 0.06, 10);
  }
}

/// Each node is compared with many cells: hundreds of nodes between two questions would take too long.
TEST(Refinement, AsksMoreOftenForLargeDisks) {
  const StaticMap map(OccupancyGrid(400, 400, 1.0), StopCondition::never());
  expect_to_end_at_every_question(map, Lattice(map.grid(), 16), 170.0, 800 * 800 / 4);
}

TEST(Refinement, AsksMoreOftenAmongPolygons) {
  const auto walls = std::make_shared<StaticMap>(OccupancyGrid(60, 60, 1.0), StopCondition::never());
  const StaticMap map(walls, {Polygon({{20.2, 20.3}, {40.1, 22.7}, {30.3, 41.9}})});
  expect_to_end_at_every_question(map, Lattice(map.grid(), 16), 0.4, 120 * 120 / 4);
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
