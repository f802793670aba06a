#include "core/bounds/tangent_graph.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

#include "tests/core/map/distances.h"
#include "tests/support/ascii_map.h"
#include "tests/support/random_problem.h"

namespace fleetplan::core {
namespace TEST_FILE {

using support::ascii_map;

constexpr double kPi = std::numbers::pi;
/// Tolerance of lengths and angles, because the disk is taken slightly smaller.
constexpr double kReduction = 1e-6;

struct World {
  World(OccupancyGrid map, double radius) : World(std::move(map), radius, radius, radius) {}
  /// `least` and `most`: the range of radii for the visibility of corners.
  World(OccupancyGrid map, double radius, double least, double most)
      : grid(std::move(map)),
        sight(grid, StopCondition::never()),
        corners(grid, least, most, StopCondition::never()),
        tangents(corners, sight, radius) {}
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  std::vector<Tangent> free_from(const Bend& bend) {
    const std::span<const Tangent> all = tangents.from(bend);
    std::vector<Tangent> free;
    for (int k = 0; k < static_cast<int>(all.size()); ++k) {
      if (tangents.is_free(bend, k)) free.push_back(all[k]);
    }
    return free;
  }

  OccupancyGrid grid;
  LineOfSight sight;
  CornerVisibility corners;
  TangentGraph tangents;
};

/// A blocked cell with its corners at (2, 2), (3, 2), (2, 3) and (3, 3).
OccupancyGrid block() {
  return ascii_map({".....",  //
                    ".....",  //
                    "..#..",  //
                    ".....",  //
                    "....."});
}

TEST(TangentGraph, TangentsFromAPointTouchTheCircleAroundTheCorner) {
  World w(block(), 0.5);
  const auto level = w.tangents.from_point({0.5, 1.5}, {1, true});
  ASSERT_TRUE(level);
  EXPECT_NEAR(level->heading, 0.0, kReduction) << "the corner (3, 2) is on the left";
  EXPECT_NEAR(level->length, 2.5, kReduction);
  EXPECT_NEAR((level->begin - Position(0.5, 1.5)).norm(), 0.0, kReduction);
  EXPECT_NEAR((level->end - Position(3.0, 1.5)).norm(), 0.0, kReduction);
  EXPECT_NEAR(level->arrive_angle, -0.25 * kPi, kReduction) << "where the quarter begins";
  EXPECT_TRUE(w.tangents.is_free(*level));
  EXPECT_FALSE(w.tangents.from_point({4.5, 4.5}, {0, true})) << "it would touch the circle inside the block";
}

TEST(TangentGraph, TangentsBetweenCornersOnOneSideRunAlongTheWall) {
  World w(block(), 0.5);
  const auto from = w.free_from({0, true});
  ASSERT_EQ(from.size(), 1u);
  EXPECT_EQ(from[0].to.corner, 1);
  EXPECT_TRUE(from[0].to.left);
  EXPECT_NEAR(from[0].length, 1.0, kReduction);
  EXPECT_NEAR(from[0].leave_angle, 0.25 * kPi, kReduction);
  EXPECT_NEAR(from[0].arrive_angle, -0.25 * kPi, kReduction);
}

TEST(TangentGraph, TangentsDoNotBeginOrEndWhereTheyOnlyGrazeAWall) {
  World w(ascii_map({".......",  //
                     ".#.#.#.",  //
                     "......."}),
          0.5);
  // The corners below the cells are 0 to 5, from the left. A single level move passes all of them.
  EXPECT_EQ(w.corners.position(5), Position(6.0, 1.0));
  std::vector<int> level;
  for (const Tangent& tangent : w.free_from({0, true})) {
    if (std::abs(tangent.heading) < kReduction) level.push_back(tangent.to.corner);
  }
  EXPECT_EQ(level, (std::vector{1, 3, 5})) << "the far sides of the cells, where a path may turn left";
  for (const Tangent& tangent : w.free_from({1, true})) EXPECT_GT(std::abs(tangent.heading), kReduction);
}

TEST(TangentGraph, TangentsCrossBetweenCornersOnDifferentSides) {
  World w(ascii_map({".....",  //
                     ".....",  //
                     "...#.",  //
                     ".#.#.",  //
                     ".#..."}),
          0.25);
  // Over (2, 2), then under (3, 1).
  int crossing = 0;
  for (int corner = 0; corner < w.corners.count(); ++corner) {
    if (w.corners.position(corner) != Position(2.0, 2.0)) continue;
    for (const Tangent& tangent : w.free_from({corner, false})) {
      if (w.corners.position(tangent.to.corner) != Position(3.0, 1.0)) continue;
      ++crossing;
      EXPECT_TRUE(tangent.to.left);
      EXPECT_NEAR(tangent.length, std::sqrt(2.0 - 0.25), kReduction);
      EXPECT_NEAR(tangent.heading, -0.25 * kPi - std::asin(0.5 / std::sqrt(2.0)), kReduction);
    }
  }
  EXPECT_EQ(crossing, 1);
}

TEST(TangentGraph, ArcsAreBlockedByOtherObstacles) {
  World w(ascii_map({".....",  //
                     "...#.",  //
                     ".....",  //
                     ".#...",  //
                     "....."}),
          0.8);
  World smaller(w.grid, 0.7);
  for (int corner = 0; corner < w.corners.count(); ++corner) {
    if ((w.corners.position(corner) - Position(2.0, 2.0)).norm() > 1e-9) continue;
    for (const bool left : {false, true}) {
      EXPECT_FALSE(w.tangents.is_arc_free({corner, left}, -0.25 * kPi, 0.25 * kPi))
          << "1.6 m in a gap of 1.41 m";
      EXPECT_TRUE(w.tangents.is_arc_free({corner, left}, -0.25 * kPi, -0.2 * kPi));
      EXPECT_TRUE(smaller.tangents.is_arc_free({corner, left}, -0.25 * kPi, 0.25 * kPi));
    }
  }
}

/// Two walls with a gap of two cells, from (4, 2) to (6, 4).
OccupancyGrid gap_of_two() {
  return ascii_map({"..........",  //
                    "..........",  //
                    "####..####",  //
                    "####..####",  //
                    "..........",  //
                    ".........."});
}

TEST(TangentGraph, TangentsDoNotRunBetweenCellCentresThroughAGapThatJustFits) {
  const auto through_gap = [](double radius) {
    World w(gap_of_two(), radius);
    EXPECT_EQ(w.corners.position(0), Position(4.0, 2.0));
    int upwards = 0;
    for (const bool left : {false, true}) {
      for (const Tangent& tangent : w.free_from({0, left})) upwards += tangent.end.y() > 3.9 ? 1 : 0;
    }
    return upwards;
  };
  EXPECT_EQ(through_gap(1.0), 0);
  EXPECT_GT(through_gap(0.99), 0) << "an oblique move fits";
  EXPECT_GT(through_gap(0.5), 0);
}

TEST(TangentGraph, TangentsHaveConsistentEndsAndClearanceOnRandomMaps) {
  const std::uint64_t seed = 43;
  support::Dice dice(seed);
  int count = 0;
  for (int k = 0; k < 60; ++k) {
    SCOPED_TRACE(testing::Message() << "seed " << seed << ", map " << k);
    const OccupancyGrid grid = support::random_map(dice);
    const double radius = grid.resolution() * dice.between(0.1, 1.5);
    World w(grid, radius);
    for (int b = 0; b < w.tangents.bend_count(); b += 3) {
      const Bend bend{b / 2, b % 2 == 1};
      const Position center = w.corners.position(bend.corner);
      for (const Tangent& tangent : w.free_from(bend)) {
        ++count;
        const Position along(std::cos(tangent.heading), std::sin(tangent.heading));
        const Position begin = tangent.end - tangent.length * along;
        ASSERT_NEAR((tangent.begin - begin).norm(), 0.0, 1e-9);
        ASSERT_NEAR((begin - center).norm(), w.tangents.radius(), 1e-9);
        ASSERT_NEAR((tangent.end - w.corners.position(tangent.to.corner)).norm(), w.tangents.radius(), 1e-9);
        ASSERT_NEAR((begin - center).dot(along), 0.0, 1e-9);
        ASSERT_GE(obstacle_distance_of(grid, begin, tangent.end),
                  radius - 3.0 * TangentGraph::kRadiusReduction);
        ASSERT_LE(std::abs(tangent.leave_angle), 0.25 * kPi + 1e-6);
        ASSERT_LE(std::abs(tangent.arrive_angle), 0.25 * kPi + 1e-6);
      }
    }
  }
  EXPECT_GT(count, 1000);
}

TEST(TangentGraph, TangentsAreTheSameIfVisibilityIsLimitedToTheRadiusOfTheDisk) {
  const std::uint64_t seed = 47;
  support::Dice dice(seed);
  int count = 0;
  int excluded = 0;
  for (int k = 0; k < 150; ++k) {
    SCOPED_TRACE(testing::Message() << "seed " << seed << ", map " << k);
    OccupancyGrid grid(30 + dice.below(60), 30 + dice.below(60), 0.5);
    const double density = dice.between(0.001, 0.15);
    for (int row = 0; row < grid.rows(); ++row) {
      for (int column = 0; column < grid.columns(); ++column) {
        if (dice.chance(density)) grid.block({column, row});
      }
    }
    const double radius = 0.5 * (dice.chance(0.3) ? 0.5 * (1 + dice.below(3)) : dice.between(0.1, 1.5));
    World all(grid, radius, 0.0, grid.width() + grid.height());
    World wide(grid, radius);
    for (int b = dice.below(17); b < all.tangents.bend_count(); b += 17) {
      const Bend bend{b / 2, b % 2 == 1};
      ASSERT_EQ(all.free_from(bend).size(), wide.free_from(bend).size());
      count += static_cast<int>(wide.free_from(bend).size());
      excluded += static_cast<int>(all.corners.bends_from(bend.corner).size()) -
                  static_cast<int>(wide.corners.bends_from(bend.corner).size());
    }
    const Position point(dice.between(0.0, grid.width()), dice.between(0.0, grid.height()));
    if (!all.sight.disk_fits(point, radius)) continue;
    const std::vector<int> seen = wide.corners.visible_from(point);
    for (int b = 0; b < all.tangents.bend_count(); ++b) {
      const Bend bend{b / 2, b % 2 == 1};
      const auto tangent = all.tangents.from_point(point, bend);
      if (!tangent || !all.tangents.is_free(*tangent)) continue;
      ASSERT_TRUE(std::binary_search(seen.begin(), seen.end(), bend.corner));
      ++count;
    }
  }
  EXPECT_GT(count, 10000);
  EXPECT_GT(excluded, 1000);
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
