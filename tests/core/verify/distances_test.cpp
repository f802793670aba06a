#include "core/verify/geometry/distances.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "tests/support/ascii_map.h"

namespace fleetplan::core {
namespace TEST_FILE {

const Rectangle kSquare{Position(2, 2), Position(3, 3)};

TEST(SegmentToRectangle, AcceptsAPointAsASegment) {
  EXPECT_EQ(nearest_to_rectangle(Position(2.5, 2.5), Position(2.5, 2.5), kSquare).distance, 0.0);
  EXPECT_EQ(nearest_to_rectangle(Position(2.5, 4), Position(2.5, 4), kSquare).distance, 1.0);
  EXPECT_DOUBLE_EQ(nearest_to_rectangle(Position(4, 4), Position(4, 4), kSquare).distance, std::sqrt(2.0));
}

TEST(SegmentToRectangle, FindsTheFirstPointOfContact) {
  const NearestPoint through = nearest_to_rectangle(Position(0, 2.5), Position(4, 2.5), kSquare);
  EXPECT_EQ(through.distance, 0.0);
  EXPECT_DOUBLE_EQ(through.fraction, 0.5);
  const NearestPoint along_side = nearest_to_rectangle(Position(0, 3), Position(4, 3), kSquare);
  EXPECT_EQ(along_side.distance, 0.0);
  EXPECT_DOUBLE_EQ(along_side.fraction, 0.5);
}

TEST(SegmentToRectangle, IsNearestAtACornerOrAnEnd) {
  const NearestPoint corner = nearest_to_rectangle(Position(0, 3), Position(3, 0), kSquare);
  EXPECT_DOUBLE_EQ(corner.distance, std::sqrt(0.5));
  EXPECT_DOUBLE_EQ(corner.fraction, 0.5);
  const NearestPoint end = nearest_to_rectangle(Position(0, 2.5), Position(1, 2.5), kSquare);
  EXPECT_EQ(end.distance, 1.0);
  EXPECT_EQ(end.fraction, 1.0);
}

TEST(SegmentToRectangle, DoesNotDependOnTheDirection) {
  for (const Position& to :
       {Position(0, 1), Position(4, 1), Position(2.5, 0), Position(9, 5), Position(1, 4)}) {
    const Position from(1, 1);
    const NearestPoint forth = nearest_to_rectangle(from, to, kSquare);
    const NearestPoint back = nearest_to_rectangle(to, from, kSquare);
    EXPECT_NEAR(forth.distance, back.distance, 1e-15);
  }
}

TEST(SegmentToRectangle, ClipsASegmentToTheRectangle) {
  const Stretch stretch = stretch_inside(Position(0, 2.5), Position(4, 2.5), kSquare);
  EXPECT_DOUBLE_EQ(stretch.first, 0.5);
  EXPECT_DOUBLE_EQ(stretch.last, 0.75);
  EXPECT_TRUE(stretch_inside(Position(0, 4), Position(4, 4), kSquare).empty());
  EXPECT_TRUE(stretch_inside(Position(0, 0), Position(0, 0), kSquare).empty());
  EXPECT_FALSE(stretch_inside(Position(2, 2), Position(2, 2), kSquare).empty());
}

// The distance to obstacles in known cases, and compared with a loop over all cells.

using support::ascii_map;

constexpr double kNoLimit = 1e9;

/// The distance of a point to the nearest blocked point, by a loop over all cells.
double plain_distance(const OccupancyGrid& grid, const Position& point) {
  double least = std::min({point.x(), grid.width() - point.x(), point.y(), grid.height() - point.y()});
  if (least <= 0.0) return 0.0;
  const double size = grid.resolution();
  for (int row = 0; row < grid.rows(); ++row) {
    for (int column = 0; column < grid.columns(); ++column) {
      if (!grid.blocked({column, row})) continue;
      const double x = std::clamp(point.x(), column * size, (column + 1) * size);
      const double y = std::clamp(point.y(), row * size, (row + 1) * size);
      least = std::min(least, std::hypot(point.x() - x, point.y() - y));
    }
  }
  return least;
}

OccupancyGrid random_grid(std::mt19937& random, double density) {
  std::uniform_int_distribution<int> size(1, 33);
  OccupancyGrid grid(size(random), size(random), std::uniform_real_distribution<double>(0.05, 2.0)(random));
  for (int row = 0; row < grid.rows(); ++row) {
    for (int column = 0; column < grid.columns(); ++column) {
      if (std::bernoulli_distribution(density)(random)) grid.block({column, row});
    }
  }
  return grid;
}

TEST(ObstacleField, ConsistsOfTheEdgeOnAFreeMap) {
  const OccupancyGrid grid = ascii_map({"....", "....", "...."});
  const ObstacleField field(grid);
  const auto nearest = field.nearest(Position(1, 1.5), Position(3.25, 1.5), kNoLimit);
  ASSERT_TRUE(nearest.has_value());
  EXPECT_TRUE(nearest->is_edge);
  EXPECT_EQ(nearest->point.distance, 0.75);
  EXPECT_EQ(nearest->point.fraction, 1.0);
  EXPECT_FALSE(field.nearest(Position(1, 1.5), Position(3.25, 1.5), 0.75).has_value());
}

TEST(ObstacleField, FindsNothingWithoutReach) {
  const OccupancyGrid grid = ascii_map({"#"});
  const ObstacleField field(grid);
  EXPECT_FALSE(field.nearest(Position(0.5, 0.5), Position(0.5, 0.5), 0.0).has_value());
  EXPECT_FALSE(field.nearest(Position(0.5, 0.5), Position(7, 7), -1.0).has_value());
}

TEST(ObstacleField, FindsTheFirstOfSeveralObstaclesEntered) {
  const OccupancyGrid grid = ascii_map({
      ".........",
      "..#..##..",
      ".........",
  });
  const ObstacleField field(grid);
  const auto forth = field.nearest(Position(0.5, 1.5), Position(8.5, 1.5), kNoLimit);
  EXPECT_EQ(forth->point.distance, 0.0);
  EXPECT_DOUBLE_EQ(forth->point.fraction, 1.5 / 8.0);
  const auto back = field.nearest(Position(8.5, 1.5), Position(0.5, 1.5), kNoLimit);
  EXPECT_DOUBLE_EQ(back->point.fraction, 1.5 / 8.0);
}

TEST(ObstacleField, FindsTheEdgeWhereTheFirstSideIsCrossed) {
  const OccupancyGrid grid = ascii_map({"....", "...."});
  const ObstacleField field(grid);
  const Position from(1, 1);
  for (const Position& to : {Position(9, 5), Position(9, -3), Position(-3, 9), Position(-3, 1.5)}) {
    const auto nearest = field.nearest(from, to, kNoLimit);
    EXPECT_EQ(nearest->point.distance, 0.0);
    const bool by_the_top = to == Position(-3, 9);  // after 1 of 8 m up; the others after 1 of 4 m
    EXPECT_DOUBLE_EQ(nearest->point.fraction, by_the_top ? 0.125 : 0.25);
  }
  EXPECT_DOUBLE_EQ(field.nearest(from, Position(9, 4), kNoLimit)->point.fraction, 1.0 / 3.0);
  EXPECT_DOUBLE_EQ(field.nearest(from, Position(9, 2.5), kNoLimit)->point.fraction, 0.375);
}

TEST(ObstacleField, PrefersACellBeforeTheEdge) {
  const OccupancyGrid grid = ascii_map({"....", "..#.", "...."});
  const ObstacleField field(grid);
  const auto leaving = field.nearest(Position(1, 1.5), Position(9, 1.5), kNoLimit);
  EXPECT_FALSE(leaving->is_edge);
  EXPECT_EQ(leaving->point.distance, 0.0);
  EXPECT_DOUBLE_EQ(leaving->point.fraction, 1.0 / 8.0);
  const auto coming = field.nearest(Position(9, 1.5), Position(1, 1.5), kNoLimit);
  EXPECT_TRUE(coming->is_edge);
  EXPECT_EQ(coming->point.fraction, 0.0);
}

TEST(ObstacleField, AgreesWithBruteForceAtPoints) {
  std::mt19937 random(7);  // NOLINT(cert-msc32-c,cert-msc51-cpp): repeatable
  for (int round = 0; round < 300; ++round) {
    SCOPED_TRACE("seed 7, round " + std::to_string(round));
    const OccupancyGrid grid = random_grid(random, 0.1);
    const ObstacleField field(grid);
    const Position point(std::uniform_real_distribution<double>(-0.2, 1.2)(random) * grid.width(),
                         std::uniform_real_distribution<double>(-0.2, 1.2)(random) * grid.height());
    EXPECT_NEAR(field.nearest(point, point, kNoLimit)->point.distance, plain_distance(grid, point), 1e-12);
  }
}

TEST(ObstacleField, AgreesWithBruteForceAlongSegments) {
  constexpr int kSamples = 1000;
  std::mt19937 random(11);  // NOLINT(cert-msc32-c,cert-msc51-cpp): repeatable
  int apart = 0;
  for (int round = 0; round < 150; ++round) {
    SCOPED_TRACE("seed 11, round " + std::to_string(round));
    const OccupancyGrid grid = random_grid(random, 0.04);
    const ObstacleField field(grid);
    const auto along = [&random](double size) {
      return std::uniform_real_distribution<double>(0.0, 1.0)(random) * size;
    };
    const Position from(along(grid.width()), along(grid.height()));
    const Position to(along(grid.width()), along(grid.height()));
    const auto nearest = field.nearest(from, to, kNoLimit);
    double least = std::numeric_limits<double>::infinity();
    for (int k = 0; k <= kSamples; ++k) {
      least = std::min(least, plain_distance(grid, from + (to - from) * k / kSamples));
    }
    EXPECT_LE(nearest->point.distance, least + 1e-12);
    EXPECT_GE(nearest->point.distance, least - (to - from).norm() / kSamples);
    const Position there = from + nearest->point.fraction * (to - from);
    EXPECT_NEAR(plain_distance(grid, there), nearest->point.distance, 1e-9);
    if (nearest->point.distance > 0.0) ++apart;

    // A limited reach finds the same distance, or nothing if nothing is within reach.
    const double reach = along(2.0 * nearest->point.distance + 0.1);
    const auto limited = field.nearest(from, to, reach);
    EXPECT_EQ(limited.has_value(), nearest->point.distance < reach);
    EXPECT_EQ(limited.value_or(*nearest).point.distance, nearest->point.distance);
  }
  EXPECT_GT(apart, 30);
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
