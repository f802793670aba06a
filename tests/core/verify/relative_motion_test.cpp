#include "core/verify/geometry/relative_motion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

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

Leg leg(double t_begin, double t_end, Position from, Position to) { return {t_begin, t_end, from, to}; }

double least(const Leg& a, const Leg& b, double margin) {
  return least_shifted_distance(a, {a.t_begin, a.t_end}, b, {b.t_begin, b.t_end}, margin).distance;
}

TEST(ShiftedMotion, WithoutAMarginIsTheDistanceAtEqualTimes) {
  const Leg a = leg(0, 10, {0, 0}, {10, 0});
  EXPECT_NEAR(least(a, leg(0, 10, {3, 0}, {13, 0}), 0.0), 3.0, 1e-12);
  EXPECT_NEAR(least(a, leg(0, 10, {5, 5}, {5, -5}), 0.0), 0.0, 1e-12);
}

TEST(ShiftedMotion, ComesNearerByTheMargin) {
  const Leg a = leg(0, 10, {0, 0}, {10, 0});
  EXPECT_NEAR(least(a, leg(0, 10, {3, 0}, {13, 0}), 2.0), 1.0, 1e-12);
  EXPECT_NEAR(least(a, leg(0, 10, {3, 4}, {13, 4}), 5.0), 4.0, 1e-12);
  // Crosses the line 3 s after the other one.
  const Leg across = leg(0, 10, {2, 5}, {2, -5});
  EXPECT_GT(least(a, across, 2.0), 0.5);
  EXPECT_NEAR(least(a, across, 3.0), 0.0, 1e-12);
  EXPECT_NEAR(least(a, across, 8.0), 0.0, 1e-12);
}

TEST(ShiftedMotion, ToAndFromTheOtherOneIsNotAMeeting) {
  // All displacements lie on one line with the origin, up to rounding.
  for (int k = 1; k < 200; ++k) {
    const Position direction(std::cos(0.01 * k), std::sin(0.01 * k));
    const Leg a = leg(0, 3, 10.0 * direction, 13.0 * direction);
    const Leg b = leg(0, 3, 20.0 * direction, (20.0 + 0.1 * k) * direction);
    EXPECT_GT(least(a, b, 1.0), 6.9) << k;
  }
}

TEST(ShiftedMotion, IsInfinitelyFarIfTheTimesAreTooFarApart) {
  const Leg a = leg(0, 1, {0, 0}, {1, 0});
  const Leg b = leg(3, 4, {1, 0}, {0, 0});
  EXPECT_EQ(least(a, b, 1.9), std::numeric_limits<double>::infinity());
  EXPECT_NEAR(least(a, b, 2.0), 0.0, 1e-12);
}

class RandomShiftedMotion : public testing::TestWithParam<int> {};

TEST_P(RandomShiftedMotion, IsWhatSamplesFind) {
  SCOPED_TRACE(testing::Message() << "seed " << GetParam());
  std::mt19937 random(static_cast<unsigned>(GetParam()));
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<>(low, high)(random);
  };
  const auto position = [&] { return Position(uniform(0, 5), uniform(0, 5)); };
  Leg a = leg(uniform(0, 2), uniform(2.1, 6), position(), position());
  Leg b = leg(uniform(0, 2), uniform(2.1, 6), position(), position());
  if (GetParam() % 5 == 0) b.to = b.from;
  if (GetParam() % 7 == 0) b.to = b.from + (a.to - a.from);
  const double margin = uniform(0, 3);
  double sampled = std::numeric_limits<double>::infinity();
  constexpr int kSteps = 300;
  for (int i = 0; i <= kSteps; ++i) {
    const double s = a.t_begin + (a.t_end - a.t_begin) * i / kSteps;
    const double low = std::max(b.t_begin, s - margin);
    const double high = std::min(b.t_end, s + margin);
    for (int j = 0; j <= kSteps && low <= high; ++j) {
      const double t = low + (high - low) * j / kSteps;
      sampled = std::min(sampled, (position_at(a, s) - position_at(b, t)).norm());
    }
  }
  const ShiftedMoment nearest =
      least_shifted_distance(a, {a.t_begin, a.t_end}, b, {b.t_begin, b.t_end}, margin);
  EXPECT_LE(nearest.distance, sampled + 1e-9);
  EXPECT_GE(nearest.distance, sampled - 0.06);
  EXPECT_LE(std::abs(nearest.t_first - nearest.t_second), margin + 1e-9);
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomShiftedMotion, testing::Range(0, 100));

}  // namespace TEST_FILE
}  // namespace fleetplan::core
