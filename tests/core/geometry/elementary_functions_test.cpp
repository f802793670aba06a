#include "core/geometry/elementary_functions.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <random>
#include <string>

namespace fleetplan::core {
namespace {

constexpr int kTries = 300'000;

/// Numbers of all sizes up to `largest`, of both signs, some of them whole.
class Numbers {
 public:
  double next(double largest) {
    const double x = 2.0 * largest * unit() - largest;
    ++tries_;
    if (tries_ % 5 == 0) return std::round(x);
    return tries_ % 3 == 0 ? std::ldexp(x, -static_cast<int>(random_() % 40)) : x;
  }
  double unit() { return std::ldexp(static_cast<double>(random_() >> 11), -53); }

 private:
  std::mt19937_64 random_{20261129};
  int tries_ = 0;
};

/// How far a result is from the exact one, in units in the last place.
double error_of(double result, long double exact) {
  const double size = std::abs(static_cast<double>(exact));
  const double unit = std::nextafter(size, std::numeric_limits<double>::infinity()) - size;
  return std::abs(static_cast<double>((result - exact) / unit));
}

TEST(ElementaryFunctions, AreRoundedToTheLastDigit) {
  Numbers numbers;
  for (int k = 0; k < kTries; ++k) {
    const double angle = numbers.next(k % 2 == 0 ? 4.0 : 1e6);
    ASSERT_LT(error_of(sine(angle), std::sin(static_cast<long double>(angle))), 1.0) << angle;
    ASSERT_LT(error_of(cosine(angle), std::cos(static_cast<long double>(angle))), 1.0) << angle;
    ASSERT_EQ(unit_vector(angle), Position(cosine(angle), sine(angle)));
    const double y = numbers.next(50.0);
    const double x = numbers.next(50.0);
    const long double direction = std::atan2(static_cast<long double>(y), static_cast<long double>(x));
    ASSERT_LT(error_of(arctangent(y, x), direction), 1.0) << y << ' ' << x;
    const double above = std::abs(numbers.next(1e6)) + 1e-12;
    ASSERT_LT(error_of(natural_logarithm(above), std::log(static_cast<long double>(above))), 2.0) << above;
    const double exponent = numbers.next(60.0);
    ASSERT_LT(error_of(power_of_two(exponent), std::exp2(static_cast<long double>(exponent))), 2.0)
        << exponent;
  }
}

TEST(ElementaryFunctions, AreExactWhereHeadingsOftenAre) {
  constexpr double kPi = std::numbers::pi;
  EXPECT_EQ(sine(0.0), 0.0);
  EXPECT_EQ(cosine(0.0), 1.0);
  EXPECT_EQ(sine(kPi / 2.0), 1.0);
  EXPECT_EQ(cosine(kPi), -1.0);
  EXPECT_EQ(natural_logarithm(1.0), 0.0);
  EXPECT_EQ(power_of_two(-3.0), 0.125);
  for (const double length : {1.0, 0.05, 1e-300, 1e300}) {
    EXPECT_EQ(arctangent(0.0, length), 0.0);
    EXPECT_EQ(arctangent(length, length), kPi / 4.0);
    EXPECT_EQ(arctangent(length, 0.0), kPi / 2.0);
    EXPECT_EQ(arctangent(length, -length), 0.75 * kPi);
    EXPECT_EQ(arctangent(0.0, -length), kPi);
    EXPECT_EQ(arctangent(-0.0, -length), -kPi);
    EXPECT_EQ(arctangent(-length, 0.0), -kPi / 2.0);
  }
  EXPECT_EQ(heading_of({-1.0, -0.0}), kPi);  // within (-pi, pi]
  EXPECT_EQ(heading_of({0.0, 0.0}), 0.0);
}

// Recorded with g++ 12 on x86-64; the same with and without fused multiply-add, and on arm64.
TEST(ElementaryFunctions, HaveTheSameDigitsOnEveryMachine) {
  Numbers numbers;
  std::uint64_t digest = 14695981039346656037u;
  const auto add = [&](double x) { digest = (digest ^ std::bit_cast<std::uint64_t>(x)) * 1099511628211u; };
  for (int k = 0; k < kTries; ++k) {
    const double a = numbers.next(10.0);
    add(sine(a));
    add(cosine(a));
    add(arctangent(a, numbers.next(10.0)));
    add(natural_logarithm(numbers.unit() + 1e-9));
    add(power_of_two(a));
  }
  EXPECT_EQ(digest, 3644770113785570765u);
}

}  // namespace
}  // namespace fleetplan::core
