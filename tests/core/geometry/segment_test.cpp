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

TEST(CrossProduct, IsPositiveForADirectionToTheLeft) {
  EXPECT_EQ(cross_product({2, 0}, {1, 3}), 6.0);
  EXPECT_EQ(cross_product({1, 3}, {2, 0}), -6.0);
  EXPECT_EQ(cross_product({2, 1}, {4, 2}), 0.0);
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
