#include "core/execution/conflict_region.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/random_problem.h"

namespace fleetplan::core {
namespace TEST_FILE {

Segment line(double x0, double y0, double x1, double y1) { return {{x0, y0}, {x1, y1}}; }

TEST(ConflictRegion, OfACrossingIsAnEllipse) {
  const ConflictRegion region(line(0, 0, 4, 0), line(2, -2, 2, 2), 1.0);
  const auto second = region.second_beyond(0.0);
  ASSERT_TRUE(second);
  EXPECT_NEAR(second->least, 0.25, 1e-12);
  EXPECT_NEAR(second->most, 0.75, 1e-12);
  // Beyond the centre only half a metre is left to its border.
  const auto beyond = region.second_beyond(0.5 + 0.5 / 4.0);
  ASSERT_TRUE(beyond);
  EXPECT_NEAR(beyond->least, 0.5 - std::sqrt(0.75) / 4.0, 1e-12);
  EXPECT_FALSE(region.second_beyond(0.75));
  const auto first = region.first_up_to(0.5 - 0.5 / 4.0);
  ASSERT_TRUE(first);
  EXPECT_NEAR(first->most, 0.5 + std::sqrt(0.75) / 4.0, 1e-12);
  EXPECT_FALSE(region.first_up_to(0.25));
}

TEST(ConflictRegion, OfRobotsThatFollowEachOtherIsAStrip) {
  const ConflictRegion region(line(0, 0, 10, 0), line(0, 0, 10, 0), 1.0);
  EXPECT_NEAR(region.second_beyond(0.5)->least, 0.4, 1e-12);
  EXPECT_NEAR(region.first_up_to(0.5)->most, 0.6, 1e-12);
  EXPECT_EQ(region.first_up_to(1.0)->most, 1.0);
  // Head on.
  const ConflictRegion opposite(line(0, 0, 10, 0), line(10, 0, 0, 0), 1.0);
  EXPECT_NEAR(opposite.second_beyond(0.5)->most, 0.6, 1e-12);
  EXPECT_NEAR(opposite.second_beyond(0.0)->least, 0.0, 1e-12);
}

TEST(ConflictRegion, OfARobotThatStandsIsABand) {
  const ConflictRegion region(line(5, 0, 5, 0), line(0, 0, 10, 0), 1.0);
  EXPECT_NEAR(region.second_beyond(0.3)->least, 0.4, 1e-12);
  EXPECT_EQ(region.first_up_to(0.5)->most, 1.0);
  EXPECT_FALSE(region.first_up_to(0.39));
}

TEST(ConflictRegion, IsEmptyForLinesThatOnlyTouch) {
  const ConflictRegion region(line(0, 0, 10, 0), line(0, 1, 10, 1), 1.0);
  EXPECT_FALSE(region.second_beyond(0.0));
  EXPECT_FALSE(region.first_up_to(1.0));
  EXPECT_TRUE(ConflictRegion(line(0, 0, 10, 0), line(0, 1, 10, 1), 1.0 + 1e-9).second_beyond(0.0));
}

/// Compares both ranges with those of a fine raster of shares.
TEST(ConflictRegion, HasTheRangesOfARaster) {
  constexpr int kSteps = 100;
  for (int seed = 0; seed < 300; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    support::Dice dice(static_cast<std::uint64_t>(seed));
    const auto place = [&] { return Position(dice.between(0, 5), dice.between(0, 5)); };
    Segment a{place(), place()};
    Segment b{place(), place()};
    if (dice.chance(0.2)) b = {b.from, b.from + 0.7 * (a.to - a.from)};
    if (dice.chance(0.1)) a.to = a.from;
    const double distance = dice.between(0.2, 2.0);
    const double from = dice.between(-0.2, 1.0);
    const double to = dice.between(0.0, 1.2);
    double least = 2.0;
    double most = -1.0;
    for (int i = 0; i <= kSteps; ++i) {
      for (int k = 0; k <= kSteps; ++k) {
        const double u = static_cast<double>(i) / kSteps;
        const double v = static_cast<double>(k) / kSteps;
        const Position apart = a.from + u * (a.to - a.from) - b.from - v * (b.to - b.from);
        if (apart.norm() >= distance) continue;
        if (u >= from) least = std::min(least, v);
        if (v <= to) most = std::max(most, u);
      }
    }
    const ConflictRegion region(a, b, distance);
    const auto second = region.second_beyond(from);
    const auto first = region.first_up_to(to);
    if (least <= 1.0) {
      ASSERT_TRUE(second);
      EXPECT_LE(second->least, least + 1e-12);
      // It is no less than necessary: there is a point of the region's border.
      const Position at = b.from + second->least * (b.to - b.from);
      EXPECT_LE(nearest_shares({a.from + std::max(0.0, from) * (a.to - a.from), a.to}, {at, at}).distance,
                distance + 1e-9);
    }
    if (most >= 0.0) {
      ASSERT_TRUE(first);
      EXPECT_GE(first->most, most - 1e-12);
      const Position at = a.from + first->most * (a.to - a.from);
      EXPECT_LE(nearest_shares({at, at}, {b.from, b.from + std::min(1.0, to) * (b.to - b.from)}).distance,
                distance + 1e-9);
    }
    const NearestShares nearest = nearest_shares(a, b);
    const Position apart =
        a.from + nearest.at.first * (a.to - a.from) - b.from - nearest.at.second * (b.to - b.from);
    EXPECT_NEAR(apart.norm(), nearest.distance, 1e-12);
    if (least <= 1.0 && from <= 0.0) {
      EXPECT_LT(nearest.distance, distance);
    }
  }
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
