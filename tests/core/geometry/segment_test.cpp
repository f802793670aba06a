#include "core/geometry/segment.h"

#include <gtest/gtest.h>

namespace fleetplan::core {
namespace TEST_FILE {

TEST(Segment, IsNearestToAPointBesideItOrAtAnEnd) {
  const Segment segment{{1, 1}, {5, 1}};
  EXPECT_EQ(nearest_share(segment, {2, 4}), 0.25);
  EXPECT_EQ(distance_to_segment({2, 4}, segment), 3.0);
  EXPECT_EQ(nearest_share(segment, {9, 4}), 1.0);
  EXPECT_EQ(distance_to_segment({9, 4}, segment), 5.0);
  EXPECT_EQ(nearest_share(segment, {-2, -3}), 0.0);
  EXPECT_EQ(distance_to_segment({-2, -3}, segment), 5.0);
  EXPECT_EQ(distance_to_segment({3, 1}, segment), 0.0);
}

TEST(Segment, OfLengthZeroIsAPoint) {
  const Segment point{{1, 1}, {1, 1}};
  EXPECT_EQ(nearest_share(point, {4, 5}), 0.0);
  EXPECT_EQ(distance_to_segment({4, 5}, point), 5.0);
}

TEST(SafeInterval, ContainsItsEnds) {
  const SafeInterval interval{1.0, 2.0};
  EXPECT_TRUE(interval.contains(1.0));
  EXPECT_TRUE(interval.contains(1.5));
  EXPECT_TRUE(interval.contains(2.0));
  EXPECT_FALSE(interval.contains(0.999));
  EXPECT_FALSE(interval.contains(2.001));
}

TEST(SafeInterval, IsUnboundedByDefault) {
  EXPECT_TRUE(SafeInterval{}.contains(0.0));
  EXPECT_TRUE(SafeInterval{}.contains(1e300));
  EXPECT_FALSE(SafeInterval{}.contains(-1e-300));
}

TEST(UnsafeInterval, ExcludesItsEnds) {
  const UnsafeInterval interval{1.0, 2.0};
  EXPECT_FALSE(interval.contains(1.0));
  EXPECT_TRUE(interval.contains(1.5));
  EXPECT_FALSE(interval.contains(2.0));
}

TEST(UnsafeInterval, IsEmptyUnlessBeginIsBeforeEnd) {
  EXPECT_TRUE(UnsafeInterval{}.empty());
  EXPECT_TRUE((UnsafeInterval{1.0, 1.0}.empty()));
  EXPECT_TRUE((UnsafeInterval{2.0, 1.0}.empty()));
  EXPECT_TRUE((UnsafeInterval{kForever, -kForever}.empty()));
  EXPECT_FALSE((UnsafeInterval{1.0, kForever}.empty()));
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
