#include "core/map/distance_transform.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdint>

#include "tests/support/ascii_map.h"
#include "tests/support/random_problem.h"

namespace fleetplan::core {
namespace TEST_FILE {

/// To the nearest blocked cell, the ring around the map included.
int squared_distance(const OccupancyGrid& grid, Cell cell) {
  int least = DistanceTransform::kMostSquared;
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
  EXPECT_EQ(distances.squared({300, 300}), DistanceTransform::kMostSquared);
  EXPECT_EQ(distances.squared({300, 9}), 100);
}

TEST(DistanceTransform, IsNotFinishedIfTheStopConditionIsMet) {
  const OccupancyGrid grid(40, 200, 1.0);
  const StopCondition far(StopCondition::Clock::now() + std::chrono::hours(1));
  step_clock = {};
  EXPECT_TRUE(DistanceTransform(grid, far).finished());
  const std::int64_t all = step_clock.steps;
  EXPECT_GT(all, 3 * 200 / 16);
  for (std::int64_t end = 0; end < all; ++end) {
    step_clock = {0, end};
    EXPECT_FALSE(DistanceTransform(grid, far).finished());
    EXPECT_EQ(step_clock.steps, end + 1);
  }
  step_clock = {};
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
