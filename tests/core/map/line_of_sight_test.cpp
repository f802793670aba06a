#include "core/map/line_of_sight.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/core/map/distances.h"
#include "tests/support/ascii_map.h"
#include "tests/support/random_problem.h"

namespace fleetplan::core {
namespace TEST_FILE {

constexpr double kOverlap = 1e-6;  // metres; more than contact

/// Tests both directions, which must agree.
bool sees(const OccupancyGrid& grid, const Position& from, const Position& to, double radius) {
  const LineOfSight sight(grid, StopCondition::never());
  const bool there = sight.may_sweep(from, to, radius);
  EXPECT_EQ(sight.may_sweep(to, from, radius), there);
  return there;
}

TEST(LineOfSight, AllowsDiskThatJustFitsGap) {
  const OccupancyGrid grid = support::ascii_map({"##.##",  //
                                                 ".....",  //
                                                 "##.##"});
  EXPECT_TRUE(sees(grid, {0.5, 1.5}, {4.5, 1.5}, 0.5)) << "a corridor as wide as the disk";
  EXPECT_FALSE(sees(grid, {0.5, 1.5}, {4.5, 1.5}, 0.5 + kOverlap));
  EXPECT_FALSE(sees(grid, {0.5, 1.5 + kOverlap}, {4.5, 1.5 + kOverlap}, 0.5));
  EXPECT_TRUE(sees(grid, {2.5, 0.5}, {2.5, 2.5}, 0.5)) << "vertical";
  EXPECT_FALSE(sees(grid, {2.5 - kOverlap, 0.5}, {2.5 - kOverlap, 2.5}, 0.5));
}

TEST(LineOfSight, FindsTheLargestDiskThatFits) {
  const LineOfSight sight(support::ascii_map({".....",  //
                                              "....#",  //
                                              "....."}),
                          StopCondition::never());
  EXPECT_EQ(sight.fitting_radius({1.5, 1.5}, 0.1, 1.0), 1.0);
  EXPECT_NEAR(sight.fitting_radius({1.0, 1.5}, 0.5, 1.5), 1.0, 1e-9) << "the edge of the map";
  EXPECT_NEAR(sight.fitting_radius({3.2, 1.5}, 0.5, 1.5), 0.8, 1e-9);
  EXPECT_NEAR(sight.fitting_radius({3.7, 2.3}, 0.1, 1.5), std::hypot(0.3, 0.3), 1e-9) << "a corner";
  const double fits = sight.fitting_radius({3.2, 1.5}, 0.5, 1.5);
  EXPECT_TRUE(sight.disk_fits({3.2, 1.5}, fits));
  EXPECT_EQ(sight.fitting_radius({3.9, 1.5}, 0.5, 1.5), 0.5) << "not even that fits";
}

TEST(LineOfSight, KeepsRadiusFromCorners) {
  const OccupancyGrid grid = support::ascii_map({".....",  //
                                                 ".....",  //
                                                 "..#..",  //
                                                 ".....",  //
                                                 "....."});
  // The diagonal (1, 3)-(2, 4) passes the corner (2, 3) at a distance of sqrt(1/2).
  const double clearance = std::sqrt(0.5);
  EXPECT_TRUE(sees(grid, {1, 3}, {2, 4}, clearance));
  EXPECT_FALSE(sees(grid, {1, 3}, {2, 4}, clearance + kOverlap));
  EXPECT_FALSE(sees(grid, {0.5, 2.5}, {4.5, 2.5}, 0.01)) << "through the block";
  EXPECT_FALSE(sees(grid, {1, 1}, {4, 4}, 0.01)) << "through it diagonally";
}

TEST(LineOfSight, IsBlockedBetweenCellsThatTouchAtCorner) {
  const OccupancyGrid grid = support::ascii_map({".#",  //
                                                 "#."});
  EXPECT_FALSE(sees(grid, {0.5, 1.5}, {1.5, 0.5}, 0.01));
}

TEST(LineOfSight, EndsAtMapEdge) {
  const OccupancyGrid grid(4, 3, 0.5);  // 2 m x 1.5 m
  EXPECT_TRUE(sees(grid, {0.2, 0.2}, {1.8, 1.3}, 0.2));
  EXPECT_TRUE(sees(grid, {0.2, 0.2}, {0.2, 1.3}, 0.2));
  EXPECT_FALSE(sees(grid, {0.2 - kOverlap, 0.2}, {1.8, 1.3}, 0.2));
  EXPECT_FALSE(sees(grid, {0.2, 0.2 - kOverlap}, {1.8, 1.3}, 0.2));
  EXPECT_FALSE(sees(grid, {0.2, 0.2}, {1.8 + kOverlap, 1.3}, 0.2));
  EXPECT_FALSE(sees(grid, {0.2, 0.2}, {1.8, 1.3 + kOverlap}, 0.2));
  EXPECT_FALSE(sees(grid, {1.0, 1.0}, {1.0, 9.0}, 0.2));
}

TEST(LineOfSight, TestsStandingDisk) {
  const OccupancyGrid grid = support::ascii_map({"...",  //
                                                 "..#",  //
                                                 "..."});
  const LineOfSight sight(grid, StopCondition::never());
  EXPECT_TRUE(sight.disk_fits({1.0, 1.5}, 1.0));
  EXPECT_FALSE(sight.disk_fits({1.0 + kOverlap, 1.5}, 1.0));
  EXPECT_TRUE(sight.disk_fits({1.5, 2.5}, 0.5));
  EXPECT_FALSE(sight.disk_fits({2.5, 1.5}, 0.01)) << "inside a block";
}

class LineOfSightOnRandomMaps : public testing::TestWithParam<double> {};

TEST_P(LineOfSightOnRandomMaps, AgreesWithDistanceToBlockedCells) {
  const double resolution = GetParam();
  const std::uint64_t seed = 7;
  support::Dice dice(seed);
  int seen = 0;
  int blocked = 0;
  for (int map = 0; map < 40; ++map) {
    OccupancyGrid grid(1 + dice.below(30), 1 + dice.below(30), resolution);
    const double density = dice.between(0.0, 0.15);
    for (int i = 0; i < grid.columns() * grid.rows(); ++i) {
      if (dice.chance(density)) grid.block({i % grid.columns(), i / grid.columns()});
    }
    const LineOfSight sight(grid, StopCondition::never());
    const auto place = [&] {
      Position p(dice.between(0, grid.width()), dice.between(0, grid.height()));
      if (dice.chance(0.3)) p = grid.center(grid.cell_at(p));
      return p;
    };
    for (int k = 0; k < 250; ++k) {
      SCOPED_TRACE(testing::Message() << "seed " << seed << ", map " << map << ", capsule " << k);
      const Position from = place();
      Position to = dice.chance(0.1) ? from : place();
      if (dice.chance(0.15)) to.x() = from.x();
      if (dice.chance(0.15)) to.y() = from.y();
      const double radius = resolution * dice.between(0.05, dice.chance(0.5) ? 1.0 : 3.0);
      const double distance = obstacle_distance_of(grid, from, to);
      const bool sees = sight.may_sweep(from, to, radius);
      ASSERT_EQ(sight.may_sweep(to, from, radius), sees) << "backwards";
      if (std::abs(distance - radius) < 1e-8) continue;  // in contact, as in the tests above
      ASSERT_EQ(sees, distance > radius) << "from " << from.transpose() << " to " << to.transpose()
                                         << ", radius " << radius << ", distance " << distance;
      ++(sees ? seen : blocked);
    }
  }
  EXPECT_GT(seen, 1000);
  EXPECT_GT(blocked, 1000);
}

/// Disks that are many cells large, between obstacles of all sizes.
TEST(LineOfSight, AgreesWithDistanceOnFineMaps) {
  const std::uint64_t seed = 19;
  support::Dice dice(seed);
  int seen = 0;
  int blocked = 0;
  for (int map = 0; map < 12; ++map) {
    OccupancyGrid grid(150 + dice.below(100), 100 + dice.below(60), 0.05);
    for (int k = 0; k < 14; ++k) {
      const Cell low{dice.below(grid.columns()), dice.below(grid.rows())};
      const Cell high{std::min(grid.columns(), low.column + 1 + dice.below(dice.chance(0.5) ? 3 : 40)),
                      std::min(grid.rows(), low.row + 1 + dice.below(dice.chance(0.5) ? 3 : 40))};
      for (int row = low.row; row < high.row; ++row) {
        for (int column = low.column; column < high.column; ++column) grid.block({column, row});
      }
    }
    const LineOfSight sight(grid, StopCondition::never());
    const auto place = [&] {
      return Position(dice.between(0, grid.width()), dice.between(0, grid.height()));
    };
    for (int k = 0; k < 250; ++k) {
      SCOPED_TRACE(testing::Message() << "seed " << seed << ", map " << map << ", capsule " << k);
      const Position from = place();
      const Position to =
          dice.chance(0.2) ? from : Position(from + dice.between(0.01, 1.0) * (place() - from));
      const double distance = obstacle_distance_of(grid, from, to);
      // Often nearly in contact.
      const double radius = dice.chance(0.5) ? distance + dice.between(-0.05, 0.05) : dice.between(0.01, 0.9);
      if (radius <= 0.0 || std::abs(distance - radius) < 1e-8) continue;
      const bool sees = sight.may_sweep(from, to, radius);
      ASSERT_EQ(sees, distance > radius) << "from " << from.transpose() << " to " << to.transpose()
                                         << ", radius " << radius << ", distance " << distance;
      ++(sees ? seen : blocked);
      const double at_start = obstacle_distance_of(grid, from, from);
      ASSERT_LT(sight.surely_free(from, radius), at_start - radius);
      ASSERT_LT(sight.surely_blocked(from, radius), radius - at_start);
      ASSERT_GT(sight.surely_free(from, radius), at_start - radius - 2.0 * grid.resolution());
      ASSERT_GT(sight.surely_blocked(from, radius), radius - at_start - 2.0 * grid.resolution());
    }
  }
  EXPECT_GT(seen, 500);
  EXPECT_GT(blocked, 500);
}

/// Disks so large that squares of cells are looked at first, and the distance transform does not tell.
TEST(LineOfSight, AgreesWithDistanceForHugeDisks) {
  support::Dice dice(23);
  int seen = 0;
  int blocked = 0;
  for (int map = 0; map < 6; ++map) {
    OccupancyGrid grid(700 + dice.below(200), 700 + dice.below(200), 1.0);
    std::vector<Cell> cells;
    for (int k = 0; k < 6; ++k) {
      cells.push_back({dice.below(grid.columns()), dice.below(grid.rows())});
      grid.block(cells.back());
    }
    const LineOfSight sight(grid, StopCondition::never());
    for (int k = 0; k < 300; ++k) {
      const Position from(dice.between(0, grid.width()), dice.between(0, grid.height()));
      const Position to =
          dice.chance(0.5) ? from : Position(from + Position(dice.between(0, 90), dice.between(-90, 90)));
      double distance = std::min({from.x(), from.y(), grid.width() - from.x(), grid.height() - from.y(),
                                  to.x(), to.y(), grid.width() - to.x(), grid.height() - to.y()});
      for (const Cell& cell : cells) {
        const Position low(cell.column, cell.row);
        distance = std::min(distance, segment_to_rectangle(from, to, low, low + Position(1, 1)));
      }
      const double radius = dice.chance(0.5) ? distance + dice.between(-1, 1) : dice.between(129, 330);
      if (radius < 129.0 || std::abs(distance - radius) < 1e-8) continue;
      ASSERT_EQ(sight.may_sweep(from, to, radius), distance > radius)
          << "map " << map << " from " << from.transpose() << " to " << to.transpose() << ", radius "
          << radius;
      ++(distance > radius ? seen : blocked);
    }
  }
  EXPECT_GT(seen, 50);
  EXPECT_GT(blocked, 50);
}

INSTANTIATE_TEST_SUITE_P(Resolutions, LineOfSightOnRandomMaps, testing::Values(0.05, 0.5, 1.0, 2.0));

}  // namespace TEST_FILE
}  // namespace fleetplan::core
