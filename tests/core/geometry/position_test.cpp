#include "core/geometry/position.h"

#include <gtest/gtest.h>

#include <numbers>

namespace fleetplan::core {
namespace TEST_FILE {

constexpr double kPi = std::numbers::pi;

TEST(CrossProduct, IsPositiveForADirectionToTheLeft) {
  EXPECT_EQ(cross_product({2, 0}, {1, 3}), 6.0);
  EXPECT_EQ(cross_product({1, 3}, {2, 0}), -6.0);
  EXPECT_EQ(cross_product({2, 1}, {4, 2}), 0.0);
}

TEST(Angle, NormalisesToHalfOpenInterval) {
  EXPECT_EQ(normalize_angle(0.5), 0.5);
  EXPECT_EQ(normalize_angle(kPi), kPi);
  EXPECT_EQ(normalize_angle(-kPi), kPi);
  EXPECT_NEAR(normalize_angle(7.0), 7.0 - 2.0 * kPi, 1e-15);
  EXPECT_NEAR(normalize_angle(-7.0), 2.0 * kPi - 7.0, 1e-15);
  EXPECT_LE(std::abs(normalize_angle(1e9)), kPi);
}

TEST(Angle, RotatesTheShorterWayAndByPiCounterClockwise) {
  EXPECT_NEAR(rotation_between(3.0, -3.0), 2.0 * kPi - 6.0, 1e-15);
  EXPECT_NEAR(rotation_between(-3.0, 3.0), 6.0 - 2.0 * kPi, 1e-15);
  EXPECT_EQ(rotation_between(0.0, kPi), kPi);
  EXPECT_EQ(rotation_between(kPi, 0.0), kPi);
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
