#include "core/map/lattice.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <numbers>
#include <numeric>
#include <set>
#include <utility>
#include <vector>

#include "core/map/occupancy_grid.h"
#include "tests/core/map/distances.h"
#include "tests/support/ascii_map.h"
#include "tests/support/random_problem.h"

namespace fleetplan::core {
namespace TEST_FILE {

std::vector<std::pair<int, int>> steps_of(int connectivity) {
  const OccupancyGrid grid(1, 1, 1.0);
  const Lattice lattice(grid, connectivity);
  std::vector<std::pair<int, int>> steps;
  for (const Lattice::Step& step : lattice.steps()) steps.emplace_back(step.columns, step.rows);
  return steps;
}

/// The steps of one quadrant, the axis on its right included.
std::set<std::pair<int, int>> first_quadrant(int connectivity) {
  std::set<std::pair<int, int>> quadrant;
  for (const auto& [columns, rows] : steps_of(connectivity)) {
    if (columns > 0 && rows >= 0) quadrant.insert({columns, rows});
  }
  return quadrant;
}

TEST(LatticeNeighbourhood, DoublesByAddingNeighbouringSteps) {
  using Steps = std::set<std::pair<int, int>>;
  EXPECT_EQ(first_quadrant(4), (Steps{{1, 0}}));
  EXPECT_EQ(first_quadrant(8), (Steps{{1, 0}, {1, 1}}));
  EXPECT_EQ(first_quadrant(16), (Steps{{1, 0}, {2, 1}, {1, 1}, {1, 2}}));
  EXPECT_EQ(first_quadrant(32), (Steps{{1, 0}, {3, 1}, {2, 1}, {3, 2}, {1, 1}, {2, 3}, {1, 2}, {1, 3}}));
}

class LatticeSteps : public testing::TestWithParam<int> {};

TEST_P(LatticeSteps, AreDistinctAndSymmetric) {
  const auto steps = steps_of(GetParam());
  ASSERT_EQ(static_cast<int>(steps.size()), GetParam());
  const std::set<std::pair<int, int>> all(steps.begin(), steps.end());
  EXPECT_EQ(static_cast<int>(all.size()), GetParam());
  for (const auto& [columns, rows] : steps) {
    EXPECT_EQ(std::gcd(columns, rows), 1) << "no step is a multiple of another";
    EXPECT_TRUE(all.contains({-rows, columns})) << "turned by a quarter";
    EXPECT_TRUE(all.contains({columns, -rows})) << "mirrored";
  }
}

INSTANTIATE_TEST_SUITE_P(Connectivities, LatticeSteps, testing::Values(4, 8, 16, 32));

TEST(Lattice, KnowsHowMuchStraightLinesShortenItsMoves) {
  const auto least_straight = [](int connectivity) {
    return Lattice(OccupancyGrid(3, 3, 1.0), connectivity).least_straight();
  };
  EXPECT_NEAR(least_straight(4), std::hypot(1.0, 1.0) / 2.0, 1e-12) << "one up and one right";
  EXPECT_NEAR(least_straight(8), std::cos(std::numbers::pi / 8.0), 1e-12);
  // As far along (1, 0) as along the next move.
  EXPECT_NEAR(least_straight(16), std::hypot(std::sqrt(5.0) + 2.0, 1.0) / (2.0 * std::sqrt(5.0)), 1e-12);
  EXPECT_NEAR(least_straight(32), std::hypot(std::sqrt(10.0) + 3.0, 1.0) / (2.0 * std::sqrt(10.0)), 1e-12);
}

TEST(Lattice, HasAnotherSpacingThanTheMap) {
  const OccupancyGrid grid(10, 7, 0.1);
  const Lattice lattice(grid, 8, 0.3);
  EXPECT_EQ(lattice.columns(), 3) << "a fourth centre would be beyond the map";
  EXPECT_EQ(lattice.rows(), 2);
  EXPECT_NEAR(lattice.position(5).x(), 0.75, 1e-12);
  EXPECT_NEAR(lattice.position(5).y(), 0.45, 1e-12);
  EXPECT_EQ(lattice.vertex_at(grid.center({7, 4})), 5) << "an odd multiple: the centre of a cell";
  EXPECT_EQ(Lattice(grid, 8, 0.1).vertex_count(), 70);
}

TEST(Lattice, NumbersCellCentresRowByRow) {
  const Lattice lattice(OccupancyGrid(5, 3, 0.5), 8);
  EXPECT_EQ(lattice.vertex_count(), 15);
  EXPECT_EQ(lattice.vertex(2, 1), 7);
  EXPECT_EQ(lattice.position(7), Position(1.25, 0.75));
  EXPECT_EQ(lattice.spacing(), 0.5);
}

TEST(Lattice, FindsVertexAtPosition) {
  const Lattice lattice(OccupancyGrid(5, 3, 0.5), 8);
  for (int v = 0; v < lattice.vertex_count(); ++v) EXPECT_EQ(lattice.vertex_at(lattice.position(v)), v);
  EXPECT_EQ(lattice.vertex_at({1.25 + 5e-10, 0.75}), 7);
  EXPECT_EQ(lattice.vertex_at({1.25 + 5e-9, 0.75}), -1);
  EXPECT_EQ(lattice.snapped({1.25 + 5e-10, 0.75}), Position(1.25, 0.75));
  EXPECT_EQ(lattice.snapped({1.25 + 5e-9, 0.75}), Position(1.25 + 5e-9, 0.75));
  EXPECT_EQ(lattice.vertex_at({1.0, 0.5}), -1) << "where four cells meet";
  EXPECT_EQ(lattice.vertex_at({-0.25, 0.25}), -1) << "outside";
  EXPECT_EQ(lattice.vertex_at({2.75, 0.25}), -1);
  EXPECT_EQ(lattice.vertex_at({0.25, 1.75}), -1);
}

TEST(Lattice, FindsVerticesWithinDistance) {
  const std::uint64_t seed = 3;
  support::Dice dice(seed);
  for (int k = 0; k < 300; ++k) {
    SCOPED_TRACE(testing::Message() << "seed " << seed << ", case " << k);
    const Lattice lattice(OccupancyGrid(1 + dice.below(12), 1 + dice.below(12), 0.3), 8);
    const Position p(dice.between(-1.0, 4.0), dice.between(-1.0, 4.0));
    const double distance = dice.between(0.01, 2.0);
    std::vector<int> expected;
    for (int v = 0; v < lattice.vertex_count(); ++v) {
      if ((lattice.position(v) - p).norm() <= distance) expected.push_back(v);
    }
    ASSERT_EQ(lattice.vertices_near(p, distance), expected);
  }
}

TEST(FreeSpace, AllowStepsThatDiskMaySweep) {
  const std::uint64_t seed = 5;
  support::Dice dice(seed);
  for (int map = 0; map < 24; ++map) {
    SCOPED_TRACE(testing::Message() << "seed " << seed << ", map " << map);
    const OccupancyGrid grid = support::random_map(dice);
    const LineOfSight sight(grid, StopCondition::never());
    const Lattice lattice(grid, 4 << (map % 4));
    const double radius = grid.resolution() * dice.between(0.05, 1.5);
    FreeSpace space(lattice, sight, radius);
    for (int k = 0; k < 20; ++k) {
      const int v = dice.below(lattice.vertex_count());
      const std::uint32_t mask = space.steps_from(v);
      ASSERT_EQ(space.steps_from(v), mask) << "the cached answer";
      for (std::size_t i = 0; i < lattice.steps().size(); ++i) {
        const auto [columns, rows] = lattice.steps()[i];
        const Position to =
            lattice.position(v) + grid.resolution() * Position(static_cast<double>(columns), rows);
        const double distance = obstacle_distance_of(grid, lattice.position(v), to);
        if (std::abs(distance - radius) < 1e-8) continue;
        ASSERT_EQ((mask >> i & 1u) != 0, distance > radius) << "vertex " << v << ", step " << i;
      }
    }
  }
}

TEST(FreeSpace, DoNotCutCorners) {
  const OccupancyGrid grid = support::ascii_map({"..",  //
                                                 ".#"});
  const LineOfSight sight(grid, StopCondition::never());
  const Lattice lattice(grid, 8);
  FreeSpace space(lattice, sight, 0.3);
  const int bottom_left = lattice.vertex(0, 0);
  EXPECT_EQ(std::popcount(space.steps_from(bottom_left)), 1) << "only straight up";
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
