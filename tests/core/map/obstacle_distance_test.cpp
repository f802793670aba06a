#include "core/map/obstacle_distance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/core/map/distances.h"
#include "tests/support/ascii_map.h"
#include "tests/support/random_problem.h"

namespace fleetplan::core {
namespace TEST_FILE {

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

}  // namespace TEST_FILE
}  // namespace fleetplan::core
