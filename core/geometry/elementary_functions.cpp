#include "core/geometry/elementary_functions.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace fleetplan::core {
namespace {

/// An angle without its multiple of a quarter turn, as a sum of two numbers, at most pi/4.
struct Reduced {
  double high;
  double low;
  int quadrant;  // 0 to 3
};

/// By the method of Cody and Waite (Software Manual for the Elementary Functions, 1980). A quarter turn is
/// the sum of three numbers. The first two have 33 bits, so that their multiples are exact.
Reduced reduce(double angle) {
  constexpr double kFirst = 0x1.921fb54400000p+0;
  constexpr double kSecond = 0x1.0b4611a600000p-34;
  constexpr double kThird = 0x1.3198a2e037073p-69;
  const double turns = std::nearbyint(angle * (2.0 / std::numbers::pi));
  const double rest = angle - turns * kFirst;
  const double second = turns * kSecond;
  const double partly = rest - second;
  const double lost = (rest - partly) - second;
  const double third = turns * kThird - lost;
  const double high = partly - third;
  const double low = (partly - high) - third;
  return {high, low, static_cast<int>(static_cast<long long>(turns) & 3)};
}

/// The value of the polynomial with these coefficients, the constant first.
template <std::size_t kCount>
double polynomial(const std::array<double, kCount>& coefficients, double x) {
  double value = coefficients.back();
  for (std::size_t k = kCount - 1; k > 0; --k) value = coefficients[k - 1] + x * value;
  return value;
}

/// The sine of a reduced angle, by its Taylor series: the next term is below 1e-19 of it.
double sine_of(const Reduced& angle) {
  static constexpr std::array<double, 8> kSeries{
      -1.0 / 6.0,        1.0 / 120.0,        -1.0 / 5040.0,          1.0 / 362880.0,
      -1.0 / 39916800.0, 1.0 / 6227020800.0, -1.0 / 1307674368000.0, 1.0 / 355687428096000.0};
  const double square = angle.high * angle.high;
  const double change = angle.high * square * polynomial(kSeries, square);
  return angle.high + (change + angle.low * (1.0 - 0.5 * square));
}

/// The cosine, likewise.
double cosine_of(const Reduced& angle) {
  static constexpr std::array<double, 7> kSeries{
      1.0 / 24.0,        -1.0 / 720.0,         1.0 / 40320.0,         -1.0 / 3628800.0,
      1.0 / 479001600.0, -1.0 / 87178291200.0, 1.0 / 20922789888000.0};
  const double square = angle.high * angle.high;
  const double half = 0.5 * square;
  const double near_one = 1.0 - half;
  const double lost = (1.0 - near_one) - half;
  const double change = square * square * polynomial(kSeries, square);
  return near_one + (lost + (change - angle.high * angle.low));
}

double sine_of_turned(const Reduced& angle, int quadrant) {
  const double value = quadrant % 2 == 0 ? sine_of(angle) : cosine_of(angle);
  return quadrant < 2 ? value : -value;
}

/// A number as a sum of two.
struct Double {
  double high;
  double low;
};

/// A number as a sum of a number of 26 bits and a rest, whose products are exact. Dekker, A floating-point
/// technique for extending the available precision, 1971.
Double split(double x) {
  constexpr double kFactor = 134217729.0;  // 2^27 + 1
  const double scaled = kFactor * x;
  const double high = scaled - (scaled - x);
  return {high, x - high};
}

/// What a product has lost by rounding.
double lost_by_product(double a, double b, double product) {
  const Double x = split(a);
  const Double y = split(b);
  return ((x.high * y.high - product) + x.high * y.low + x.low * y.high) + x.low * y.low;
}

/// The sum of two numbers, exactly (Knuth, The Art of Computer Programming, volume 2).
Double exact_sum(double a, double b) {
  const double sum = a + b;
  const double of_b = sum - a;
  return {sum, (a - (sum - of_b)) + (b - of_b)};
}

constexpr int kEighths = 8;

/// The arctangents of 0/8 to 8/8.
constexpr std::array<Double, kEighths + 1> kArctangents{{
    {0.0, 0.0},
    {0x1.fd5ba9aac2f6ep-4, -0x1.cd37686760c17p-59},
    {0x1.f5b75f92c80ddp-3, 0x1.8ab6e3cf7afbdp-57},
    {0x1.6f61941e4def1p-2, -0x1.c63aae6f6e918p-56},
    {0x1.dac670561bb4fp-2, 0x1.a2b7f222f65e2p-56},
    {0x1.1e00babdefeb4p-1, -0x1.928df287a668fp-58},
    {0x1.4978fa3269ee1p-1, 0x1.2419a87f2a458p-56},
    {0x1.700a7c5784634p-1, -0x1.8c34d25aadef6p-56},
    {0x1.921fb54442d18p-1, 0x1.1a62633145c07p-55},
}};

/// tan(a - b), where tan a = part / whole, at most 1, and tan b = eighths / 8 is the nearest to it.
Double tangent_of_rest(double part, double whole, int eighths) {
  const double tangent = eighths / static_cast<double>(kEighths);
  const Double of_whole = split(whole);
  const double above = (part - tangent * of_whole.high) - tangent * of_whole.low;
  const double product = tangent * part;
  const double below = whole + product;
  const double below_lost = (whole - below) + product;
  const double quotient = above / below;
  const double exact = quotient * below;
  const double rest = (above - exact) - lost_by_product(quotient, below, exact) - quotient * below_lost;
  return {quotient, rest / below};
}

/// Numbers so large or small that products of them are not exact are scaled.
double scale_of(double largest) {
  constexpr double kLarge = 0x1p+500;
  constexpr double kSmall = 0x1p-400;
  if (largest > kLarge) return 0x1p-600;
  return largest < kSmall ? 0x1p+500 : 1.0;
}

}  // namespace

double sine(double angle) {
  const Reduced reduced = reduce(angle);
  return sine_of_turned(reduced, reduced.quadrant);
}

double cosine(double angle) {
  const Reduced reduced = reduce(angle);
  return sine_of_turned(reduced, (reduced.quadrant + 1) % 4);
}

Position unit_vector(double angle) {
  const Reduced reduced = reduce(angle);
  return {sine_of_turned(reduced, (reduced.quadrant + 1) % 4), sine_of_turned(reduced, reduced.quadrant)};
}

double arctangent(double y, double x) {
  static constexpr std::array<double, 6> kSeries{-1.0 / 3.0, 1.0 / 5.0,   -1.0 / 7.0,
                                                 1.0 / 9.0,  -1.0 / 11.0, 1.0 / 13.0};
  constexpr Double kQuarter{0x1.921fb54442d18p+0, 0x1.1a62633145c07p-54};
  constexpr Double kHalf{0x1.921fb54442d18p+1, 0x1.1a62633145c07p-53};
  const double scale = scale_of(std::max(std::abs(x), std::abs(y)));
  const double across = scale * std::abs(x);
  const double up = scale * std::abs(y);
  const bool is_steep = up > across;
  const double part = is_steep ? across : up;
  const double whole = is_steep ? up : across;
  const int eighths = whole > 0.0 ? static_cast<int>(std::nearbyint(kEighths * (part / whole))) : 0;
  const Double tangent = whole > 0.0 ? tangent_of_rest(part, whole, eighths) : Double{0.0, 0.0};
  // The angle is `from` plus or minus the arctangents of the eighths and of the rest.
  const bool is_left = std::signbit(x);
  const Double from = is_steep ? kQuarter : is_left ? kHalf : Double{0.0, 0.0};
  const double sign = is_steep == is_left ? 1.0 : -1.0;
  const Double& known = kArctangents[static_cast<std::size_t>(eighths)];
  const Double sum = exact_sum(from.high, sign * known.high);
  const double square = tangent.high * tangent.high;
  const double change = tangent.high * square * polynomial(kSeries, square) + tangent.low;
  const double angle =
      sum.high + (sign * tangent.high + (sum.low + from.low + sign * known.low + sign * change));
  return std::signbit(y) ? -angle : angle;
}

double heading_of(const Position& vector) { return normalize_angle(arctangent(vector.y(), vector.x())); }

double natural_logarithm(double x) {
  // ln x = e ln 2 + 2 artanh((m - 1) / (m + 1)), with x = 2^e m and m about 1.
  static constexpr std::array<double, 11> kSeries{1.0 / 3.0,  1.0 / 5.0,  1.0 / 7.0,  1.0 / 9.0,
                                                  1.0 / 11.0, 1.0 / 13.0, 1.0 / 15.0, 1.0 / 17.0,
                                                  1.0 / 19.0, 1.0 / 21.0, 1.0 / 23.0};
  constexpr Double kLogarithmOf2{0x1.62e42fee00000p-1, 0x1.a39ef35793c76p-33};
  int exponent = 0;
  double mantissa = std::frexp(x, &exponent);
  if (mantissa < std::numbers::sqrt2 / 2.0) {
    mantissa *= 2.0;
    --exponent;
  }
  const double share = (mantissa - 1.0) / (mantissa + 1.0);
  const double square = share * share;
  const double small = 2.0 * share * square * polynomial(kSeries, square) + exponent * kLogarithmOf2.low;
  return exponent * kLogarithmOf2.high + (2.0 * share + small);
}

double power_of_two(double exponent) {
  // e^x by its Taylor series, with x = ln 2 times what is left of the exponent.
  static constexpr std::array<double, 14> kSeries{1.0,
                                                  1.0,
                                                  1.0 / 2.0,
                                                  1.0 / 6.0,
                                                  1.0 / 24.0,
                                                  1.0 / 120.0,
                                                  1.0 / 720.0,
                                                  1.0 / 5040.0,
                                                  1.0 / 40320.0,
                                                  1.0 / 362880.0,
                                                  1.0 / 3628800.0,
                                                  1.0 / 39916800.0,
                                                  1.0 / 479001600.0,
                                                  1.0 / 6227020800.0};
  const double whole = std::nearbyint(exponent);
  return std::ldexp(polynomial(kSeries, (exponent - whole) * std::numbers::ln2), static_cast<int>(whole));
}

}  // namespace fleetplan::core
