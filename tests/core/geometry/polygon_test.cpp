// Polygons of the search, and polygons of the checker, which compute the same in other ways.

#include "core/geometry/polygon.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/verify/geometry/distances.h"
#include "tests/support/random_zones.h"

namespace fleetplan::core {
namespace TEST_FILE {

using Corners = std::vector<Position>;

/// The square from (2, 2) to (4, 4).
Corners square() { return {{2, 2}, {4, 2}, {4, 4}, {2, 4}}; }
/// An L whose notch is the square from (4, 4) to (6, 6).
Corners angle() { return {{2, 2}, {6, 2}, {6, 4}, {4, 4}, {4, 6}, {2, 6}}; }

TEST(Polygon, KnowsItsInside) {
  const Polygon polygon(angle());
  EXPECT_TRUE(polygon.contains({3, 5}));
  EXPECT_TRUE(polygon.contains({5, 3}));
  EXPECT_FALSE(polygon.contains({5, 5}));
  EXPECT_FALSE(polygon.contains({1, 3}));
  EXPECT_EQ(polygon.twice_signed_area(), 24.0);
}

TEST(Polygon, ContactIsNotNearer) {
  const Polygon polygon(square());
  EXPECT_FALSE(polygon.comes_near({1, 0}, {1, 9}, 1.0));
  EXPECT_TRUE(polygon.comes_near({1, 0}, {1, 9}, 1.0 + 1e-9));
  EXPECT_FALSE(polygon.comes_near({5, 5}, {5, 5}, std::sqrt(2.0) - 1e-12));
  EXPECT_TRUE(polygon.comes_near({5, 5}, {5, 5}, std::sqrt(2.0) + 1e-9));
}

TEST(Polygon, IsNearWhenASegmentIsInsideOrPassesThrough) {
  const Polygon polygon(square());
  EXPECT_TRUE(polygon.comes_near({3, 3}, {3, 3.1}, 0.01));
  EXPECT_TRUE(polygon.comes_near({0, 3}, {9, 3}, 0.01));
  EXPECT_TRUE(polygon.comes_near({2, 2}, {4, 4}, 0.01));  // from corner to corner
  EXPECT_FALSE(polygon.comes_near({0, 4.1}, {9, 4.1}, 0.01));
}

TEST(Polygon, LeavesItsNotchFree) {
  const Polygon polygon(angle());
  EXPECT_FALSE(polygon.comes_near({5, 5}, {8, 8}, 0.9));
  EXPECT_TRUE(polygon.comes_near({5, 5}, {8, 8}, 1.1));
}

TEST(Polygon, HasSpansThatEndAtItsBorder) {
  const auto through = Polygon(angle()).spans_inside({0, 3}, {8, 3});
  ASSERT_EQ(through.size(), 1U);
  EXPECT_NEAR(through[0].first, 0.25, 1e-12);
  EXPECT_NEAR(through[0].last, 0.75, 1e-12);
  EXPECT_EQ(Polygon(angle()).spans_inside({2.5, 7}, {7, 2.5}).size(), 2U);
  const auto within = Polygon(square()).spans_inside({3, 3}, {3.5, 3});
  ASSERT_EQ(within.size(), 1U);
  EXPECT_EQ(within[0].last, 1.0);
}

TEST(Polygon, HasNoSpansAlongItsBorder) {
  EXPECT_TRUE(Polygon(square()).spans_inside({0, 2}, {8, 2}).empty());
  EXPECT_TRUE(Polygon(square()).spans_inside({0, 4}, {8, 4}).empty());
  EXPECT_TRUE(Polygon(square()).spans_inside({2, 8}, {2, 0}).empty());
  EXPECT_TRUE(Polygon(square()).spans_inside({0, 6}, {4, 2}).size() == 1U);  // from corner to corner
  EXPECT_TRUE(Polygon(square()).spans_inside({1, 3}, {3, 1}).empty());       // past a corner
}

/// Both compute distances in their own way.
TEST(Polygon, SearchAndCheckAgree) {
  support::Dice dice(7);
  const OccupancyGrid grid(20, 20, 1.0);
  int near = 0;
  for (int run = 0; run < 20'000; ++run) {
    const Corners corners = support::random_polygon(dice, grid);
    const auto place = [&] { return Position(dice.between(0.0, 20.0), dice.between(0.0, 20.0)); };
    const Position from = place();
    const Position to = dice.chance(0.2) ? from : place();
    const double distance = nearest_to_polygon(from, to, corners).distance;
    const Polygon polygon(corners);
    EXPECT_TRUE(polygon.comes_near(from, to, distance + 1e-9)) << "run " << run;
    EXPECT_FALSE(distance > 1e-6 && polygon.comes_near(from, to, distance - 1e-9)) << "run " << run;
    near += distance < 1.0 ? 1 : 0;
  }
  EXPECT_GT(near, 1000);
}

TEST(StretchesInside, BeginAndEndAtTheBorder) {
  const auto through = stretches_inside({0, 3}, {8, 3}, angle(), 1e-6, StopCondition::never());
  ASSERT_EQ(through.size(), 1U);
  EXPECT_NEAR(through[0].first, 0.25, 1e-12);
  EXPECT_NEAR(through[0].last, 0.75, 1e-12);
  EXPECT_TRUE(stretches_inside({0, 7}, {8, 7}, angle(), 1e-6, StopCondition::never()).empty());
  EXPECT_TRUE(
      stretches_inside({0, 2}, {8, 2}, angle(), 1e-6, StopCondition::never()).empty());  // along the border
}

TEST(StretchesInside, AreSeveralWhereASegmentComesBack) {
  // Through both arms of the L, past its notch.
  const auto both = stretches_inside({2.5, 7}, {7, 2.5}, angle(), 1e-6, StopCondition::never());
  ASSERT_EQ(both.size(), 2U);
  EXPECT_LT(both[0].last, both[1].first);
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
