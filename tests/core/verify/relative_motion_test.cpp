#include "core/verify/geometry/relative_motion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace fleetplan::core {
namespace TEST_FILE {

TEST(RelativeMotion, KeepsItsDistanceWithoutMotion) {
  const double infinity = std::numeric_limits<double>::infinity();
  const RelativeMotion rest{3.0, infinity, Position(3, 4), Position(3, 4)};
  EXPECT_EQ(least_squared_distance(rest), 25.0);
  EXPECT_EQ(closest_moment(rest).t, 3.0);
  EXPECT_FALSE(span_closer_than(rest, 5.0).has_value());
  const auto span = span_closer_than(rest, 5.1);
  ASSERT_TRUE(span.has_value());
  EXPECT_EQ(span->begin, 3.0);
  EXPECT_EQ(span->end, infinity);
}

TEST(RelativeMotion, IsNearestWhenPassing) {
  const RelativeMotion pass{10.0, 14.0, Position(-4, 3), Position(4, 3)};
  EXPECT_DOUBLE_EQ(least_squared_distance(pass), 9.0);
  EXPECT_DOUBLE_EQ(closest_moment(pass).t, 12.0);
  const auto span = span_closer_than(pass, std::sqrt(10.0));
  ASSERT_TRUE(span.has_value());
  EXPECT_NEAR(span->begin, 11.5, 1e-12);
  EXPECT_NEAR(span->end, 12.5, 1e-12);
}

TEST(RelativeMotion, HasNoSpanWhenPassingInContact) {
  const RelativeMotion pass{0.0, 1.0, Position(-4, 3), Position(4, 3)};
  EXPECT_FALSE(span_closer_than(pass, 3.0).has_value());
  EXPECT_FALSE(span_closer_than(pass, 0.0).has_value());
  EXPECT_FALSE(span_closer_than(pass, -1.0).has_value());
}

TEST(RelativeMotion, HasExactSpansAtTheEndsOfTheMotion) {
  const RelativeMotion leaving{0.1, 0.7, Position(0, 1), Position(0, 9)};
  EXPECT_EQ(span_closer_than(leaving, 2.0)->begin, 0.1);
  EXPECT_NEAR(span_closer_than(leaving, 2.0)->end, 0.1 + 0.6 / 8.0, 1e-12);
  const RelativeMotion coming{0.1, 0.7, Position(0, 9), Position(0, 1)};
  EXPECT_EQ(span_closer_than(coming, 2.0)->end, 0.7);
}

TEST(RelativeMotion, KeepsItsPrecisionFarAway) {
  // A pass at 1 m after 1,000 km: |from|^2 alone is 1e12 m^2, with an ulp of 1e-4.
  const RelativeMotion pass{0.0, 1.0, Position(-1e6, 1.0), Position(1e6, 1.0)};
  EXPECT_NEAR(least_squared_distance(pass), 1.0, 1e-9);
}

TEST(RelativeMotion, IsNearestAtTheBeginningForNearlyEqualVelocities) {
  const RelativeMotion follow{2.0, 9.0, Position(1, 0), Position(1.0 - 1e-15, 1e-16)};
  EXPECT_EQ(closest_moment(follow).t, 2.0);
  EXPECT_NEAR(closest_moment(follow).distance, 1.0, 1e-14);
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
