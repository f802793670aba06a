#include "core/bounds/corner_visibility.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

#include "tests/core/map/distances.h"
#include "tests/support/ascii_map.h"
#include "tests/support/random_problem.h"
#include "tests/support/step_limit.h"

namespace fleetplan::core {
namespace TEST_FILE {

using support::ascii_map;
using testing::ElementsAre;
using testing::IsEmpty;

std::vector<std::pair<double, double>> places(const CornerVisibility& sight,
                                              const std::vector<int>& corners) {
  std::vector<std::pair<double, double>> found;
  found.reserve(corners.size());
  for (const int corner : corners) found.emplace_back(sight.position(corner).x(), sight.position(corner).y());
  return found;
}

std::vector<int> all(const CornerVisibility& sight) {
  std::vector<int> corners(static_cast<std::size_t>(sight.count()));
  std::iota(corners.begin(), corners.end(), 0);
  return corners;
}

TEST(CornerVisibility, HasTheConvexCornersOnly) {
  const OccupancyGrid grid = ascii_map({"#....",  //
                                        "..##.",  //
                                        "..#..",  //
                                        "....."},
                                       0.5);
  CornerVisibility sight(grid, 0.0, 0.0, StopCondition::never());
  EXPECT_THAT(places(sight, all(sight)),
              ElementsAre(std::pair(1.0, 0.5), std::pair(1.5, 0.5), std::pair(2.0, 1.0), std::pair(0.5, 1.5),
                          std::pair(1.0, 1.5), std::pair(2.0, 1.5)));
  EXPECT_EQ(sight.corner(0).away_x, -1);
  EXPECT_EQ(sight.corner(0).away_y, -1);
}

TEST(CornerVisibility, HasNoCornersAtTheEdgeOrWhereCellsTouchDiagonally) {
  const OccupancyGrid grid = ascii_map({".#.",  //
                                        "#..",  //
                                        "..."});
  CornerVisibility sight(grid, 0.0, 0.0, StopCondition::never());
  EXPECT_THAT(places(sight, all(sight)), ElementsAre(std::pair(1.0, 1.0), std::pair(2.0, 2.0)));
}

TEST(CornerVisibility, SeesAlongWallsAndNotThroughThem) {
  const OccupancyGrid grid = ascii_map({".......",  //
                                        ".##.##.",  //
                                        "......."});
  CornerVisibility sight(grid, 0.0, 0.0, StopCondition::never());
  EXPECT_THAT(places(sight, sight.visible_from({0.5, 0.5})),
              ElementsAre(std::pair(1.0, 1.0), std::pair(3.0, 1.0), std::pair(4.0, 1.0), std::pair(6.0, 1.0),
                          std::pair(1.0, 2.0)));
  EXPECT_THAT(places(sight, sight.bends_from(0)), ElementsAre(std::pair(3.0, 1.0), std::pair(4.0, 1.0),
                                                              std::pair(6.0, 1.0), std::pair(1.0, 2.0)));
  EXPECT_EQ(sight.visible_from({0.5, 1.0}), sight.visible_from({0.5, 0.5}))
      << "a line of sight may touch walls";
}

TEST(CornerVisibility, IsEmptyOnAFreeMap) {
  const OccupancyGrid grid(4, 3, 1.0);
  CornerVisibility sight(grid, 0.0, 0.0, StopCondition::never());
  EXPECT_EQ(sight.count(), 0);
  EXPECT_THAT(sight.visible_from({2.0, 1.5}), IsEmpty());
}

/// Whether the segment meets a blocked cell after the cell is reduced by `margin` cells on all sides.
bool blocked(const OccupancyGrid& grid, const Position& a, const Position& b, double margin) {
  const double size = grid.resolution();
  for (int row = 0; row < grid.rows(); ++row) {
    for (int column = 0; column < grid.columns(); ++column) {
      if (!grid.blocked({column, row})) continue;
      const Position low(column + margin, row + margin);
      if (meets(a, b, size * low, size * (low + Position(1.0 - 2.0 * margin, 1.0 - 2.0 * margin))))
        return true;
    }
  }
  return false;
}

/// Whether a thin strip on one side of the segment is free.
bool has_room(const OccupancyGrid& grid, const Position& a, const Position& b) {
  const Position along = (b - a).normalized() * grid.resolution();
  const Position aside(-along.y(), along.x());
  for (const double side : {1e-4, -1e-4}) {
    if (!blocked(grid, a + side * aside - 1e-5 * along, b + side * aside + 1e-5 * along, 0.0)) return true;
  }
  return false;
}

/// Whether a taut path can continue in this direction after it bends around the corner. It must lead beside
/// the blocked cell, neither over it nor straight away from it.
bool can_bend_towards(const Corner& corner, const Position& d) {
  return d.x() * corner.away_x * d.y() * corner.away_y <= 0.0;
}

TEST(CornerVisibility, SeesEveryCornerThatAThinStripReachesAndNoneBehindACell) {
  const std::uint64_t seed = 41;
  support::Dice dice(seed);
  int seen = 0;
  int hidden = 0;
  int excluded = 0;
  for (int k = 0; k < 120; ++k) {
    SCOPED_TRACE(testing::Message() << "seed " << seed << ", map " << k);
    const OccupancyGrid grid = support::random_map(dice);
    CornerVisibility sight(grid, 0.0, 0.0, StopCondition::never());
    if (sight.count() == 0) continue;
    for (int view = 0; view < 6; ++view) {
      const int from_corner = dice.below(sight.count());
      Position from = sight.position(from_corner);
      if (view % 2 == 0) {
        from = Position(dice.between(0.0, grid.width()), dice.between(0.0, grid.height()));
        if (view == 2)
          from = 0.5 * grid.resolution() * (2.0 * from / grid.resolution()).array().round().matrix();
        if (obstacle_distance(grid, from, 1.0) <= 0.05 * grid.resolution()) continue;
      }
      const auto found = view % 2 == 0 ? sight.visible_from(from) : sight.bends_from(from_corner);
      for (int corner = 0; corner < sight.count(); ++corner) {
        const Position to = sight.position(corner);
        if ((to - from).norm() < 0.01 * grid.resolution()) continue;
        const bool is_found = std::binary_search(found.begin(), found.end(), corner);
        const bool is_required = view % 2 == 0 || can_bend_towards(sight.corner(from_corner), to - from);
        if (is_required && has_room(grid, from, to)) {
          ASSERT_TRUE(is_found) << from.transpose() << " to " << to.transpose();
        }
        if (blocked(grid, from, to, 1e-5)) {
          ASSERT_FALSE(is_found) << from.transpose() << " to " << to.transpose();
        }
        ++(is_found ? seen : hidden);
        excluded += !is_required && !is_found && !blocked(grid, from, to, 1e-5) ? 1 : 0;
      }
    }
  }
  EXPECT_GT(seen, 1000);
  EXPECT_GT(hidden, 1000);
  EXPECT_GT(excluded, 100);
}

TEST(CornerVisibility, StopsSoonAfterTheStopConditionIsMet) {
  OccupancyGrid grid(200, 200, 1.0);
  for (int k = 0; k < 200 * 200; k += 7) grid.block({k % 200, k / 200});
  const auto look_around = [&](support::StepLimit& limit) {
    CornerVisibility sight(grid, 0.0, 0.0, support::counted(limit));
    for (int corner = 0; corner < 20 && !sight.stopped(); ++corner) sight.bends_from(corner);
    return sight.stopped();
  };
  support::StepLimit whole;
  EXPECT_FALSE(look_around(whole));
  const std::int64_t all = whole.steps();
  EXPECT_GT(all, 30);
  for (std::int64_t end = 0; end < all; end += 3) {
    support::StepLimit limit(end);
    EXPECT_TRUE(look_around(limit));
    EXPECT_EQ(limit.steps(), end + 1);
  }
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
