#include "core/map/occupancy_grid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "tests/core/map/distances.h"
#include "tests/support/ascii_map.h"
#include "tests/support/random_problem.h"
#include "tests/support/step_limit.h"

namespace fleetplan::core {
namespace TEST_FILE {

TEST(OccupancyGrid, CountsRowsFromTheBottom) {
  const OccupancyGrid grid = support::ascii_map({"#..",  //
                                                 "..#"});
  EXPECT_TRUE(grid.blocked({0, 1}));
  EXPECT_TRUE(grid.blocked({2, 0}));
  EXPECT_FALSE(grid.blocked({0, 0}));
  EXPECT_FALSE(grid.blocked({2, 1}));
}

TEST(OccupancyGrid, IsBlockedOutside) {
  const OccupancyGrid grid(3, 2, 1.0);
  for (const Cell cell : {Cell{-1, 0}, Cell{3, 0}, Cell{0, -1}, Cell{0, 2}}) {
    EXPECT_FALSE(grid.inside(cell));
    EXPECT_TRUE(grid.blocked(cell));
  }
}

TEST(OccupancyGrid, MeasuresInMetres) {
  const OccupancyGrid grid(8, 4, 0.25);
  EXPECT_EQ(grid.width(), 2.0);
  EXPECT_EQ(grid.height(), 1.0);
  EXPECT_EQ(grid.cell_count(), 32);
  EXPECT_EQ(grid.center({0, 0}), Position(0.125, 0.125));
  EXPECT_EQ(grid.center({7, 3}), Position(1.875, 0.875));
}

TEST(OccupancyGrid, BorderBelongsToCellOnRightOrAbove) {
  const OccupancyGrid grid(8, 4, 0.25);
  EXPECT_EQ(grid.cell_at({0.0, 0.0}), (Cell{0, 0}));
  EXPECT_EQ(grid.cell_at({0.25, 0.5}), (Cell{1, 2}));
  EXPECT_EQ(grid.cell_at({0.2499, 0.4999}), (Cell{0, 1}));
  EXPECT_EQ(grid.cell_at({-0.001, 1.0}), (Cell{-1, 4}));
}

TEST(ObstacleDistance, IsDistanceToNearestBlockedCell) {
  const OccupancyGrid grid = support::ascii_map({".....",  //
                                                 ".....",  //
                                                 "..#..",  //
                                                 ".....",  //
                                                 "....."},
                                                2.0);  // the block is [4, 6] x [4, 6]
  EXPECT_DOUBLE_EQ(obstacle_distance(grid, {3.0, 5.0}, 10.0), 1.0);
  EXPECT_DOUBLE_EQ(obstacle_distance(grid, {5.0, 7.5}, 10.0), 1.5);
  EXPECT_DOUBLE_EQ(obstacle_distance(grid, {3.0, 7.0}, 10.0), std::sqrt(2.0)) << "its corner";
  EXPECT_EQ(obstacle_distance(grid, {4.0, 5.0}, 10.0), 0.0) << "its side";
  EXPECT_EQ(obstacle_distance(grid, {5.0, 5.0}, 10.0), 0.0) << "inside";
}

TEST(ObstacleDistance, IsDistanceToMapEdgeFromInsideAndOutside) {
  const OccupancyGrid grid(4, 4, 0.5);
  EXPECT_DOUBLE_EQ(obstacle_distance(grid, {1.0, 0.75}, 10.0), 0.75);
  EXPECT_EQ(obstacle_distance(grid, {2.0, 1.0}, 10.0), 0.0);
  EXPECT_DOUBLE_EQ(obstacle_distance(grid, {1.0, -0.25}, 10.0), -0.25);
  EXPECT_DOUBLE_EQ(obstacle_distance(grid, {2.5, 1.0}, 10.0), -0.5);
}

TEST(ObstacleDistance, IsAtMostLimit) {
  const OccupancyGrid grid(100, 100, 1.0);
  EXPECT_EQ(obstacle_distance(grid, {50.0, 50.0}, 3.0), 3.0);
  EXPECT_EQ(obstacle_distance(grid, {2.0, 50.0}, 3.0), 2.0);
}

TEST(ObstacleDistance, AgreesWithBruteForceOnRandomMaps) {
  const std::uint64_t seed = 11;
  support::Dice dice(seed);
  for (int map = 0; map < 60; ++map) {
    const OccupancyGrid grid = support::random_map(dice);
    for (int k = 0; k < 100; ++k) {
      SCOPED_TRACE(testing::Message() << "seed " << seed << ", map " << map << ", position " << k);
      const Position p(dice.between(0, grid.width()), dice.between(0, grid.height()));
      const double limit = grid.resolution() * dice.between(0.1, 6.0);
      ASSERT_NEAR(obstacle_distance(grid, p, limit), std::min(limit, obstacle_distance_of(grid, p, p)),
                  1e-12);
    }
  }
}

/// To the nearest blocked cell, the ring around the map included.
int squared_distance(const OccupancyGrid& grid, Cell cell) {
  int least = DistanceTransform::kMaxSquared;
  for (int row = -1; row <= grid.rows(); ++row) {
    for (int column = -1; column <= grid.columns(); ++column) {
      if (!grid.blocked({column, row})) continue;
      const int dx = column - cell.column;
      const int dy = row - cell.row;
      least = std::min(least, dx * dx + dy * dy);
    }
  }
  return least;
}

TEST(DistanceTransform, IsExactOnRandomMaps) {
  const std::uint64_t seed = 3;
  support::Dice dice(seed);
  for (int map = 0; map < 40; ++map) {
    SCOPED_TRACE(testing::Message() << "seed " << seed << ", map " << map);
    const OccupancyGrid grid = support::random_map(dice);
    const DistanceTransform distances(grid, StopCondition::never());
    for (int row = 0; row < grid.rows(); ++row) {
      for (int column = 0; column < grid.columns(); ++column) {
        ASSERT_EQ(distances.squared({column, row}), squared_distance(grid, {column, row}))
            << "cell " << column << ", " << row;
      }
    }
  }
}

TEST(DistanceTransform, CountsTheOutsideAsBlocked) {
  const DistanceTransform distances(support::ascii_map({".....", ".....", "....."}), StopCondition::never());
  EXPECT_EQ(distances.squared({0, 1}), 1);
  EXPECT_EQ(distances.squared({2, 1}), 4);
}

TEST(DistanceTransform, CutsLongDistancesOff) {
  const DistanceTransform distances(OccupancyGrid(600, 600, 1.0), StopCondition::never());
  EXPECT_EQ(distances.squared({300, 300}), DistanceTransform::kMaxSquared);
  EXPECT_EQ(distances.squared({300, 9}), 100);
}

TEST(DistanceTransform, IsNotFinishedIfTheStopConditionIsMet) {
  const OccupancyGrid grid(40, 200, 1.0);
  support::StepLimit whole;
  EXPECT_TRUE(DistanceTransform(grid, support::counted(whole)).finished());
  const std::int64_t all = whole.steps();
  EXPECT_GT(all, 3 * 200 / 16);
  for (std::int64_t end = 0; end < all; ++end) {
    support::StepLimit limit(end);
    EXPECT_FALSE(DistanceTransform(grid, support::counted(limit)).finished());
    EXPECT_EQ(limit.steps(), end + 1);
  }
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
