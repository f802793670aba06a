#include <gtest/gtest.h>

#include <cmath>

#include "core/verify/geometry/obstacle_distance.h"

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

}  // namespace TEST_FILE
}  // namespace fleetplan::core
