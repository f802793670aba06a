#include "core/execution/simulation/share_test.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/geometry/elementary_functions.h"

namespace fleetplan::core {
namespace {

/// ln n! less Stirling's formula, n > 0.
double beyond_stirling(double n) {
  constexpr double kFewest = 16.0;  // the series below has an error of less than 1e-15 from here on
  if (n < kFewest) {
    double sum = 0.0;
    for (double k = 2.0; k <= n; ++k) sum += natural_logarithm(k);
    return sum - ((n + 0.5) * natural_logarithm(n) - n + 0.5 * natural_logarithm(2.0 * std::numbers::pi));
  }
  constexpr std::array<double, 5> kTerms{1.0 / 12.0, -1.0 / 360.0, 1.0 / 1260.0, -1.0 / 1680.0, 1.0 / 1188.0};
  double sum = 0.0;
  for (auto term = kTerms.rbegin(); term != kTerms.rend(); ++term) sum = sum / (n * n) + *term;
  return sum / n;
}

/// count ln(count / mean) + mean - count, also where the two are near to each other.
double deviance(double count, double mean) {
  const double v = (count - mean) / (count + mean);
  constexpr double kNear = 0.1;
  if (std::abs(v) > kNear) return count * natural_logarithm(count / mean) + mean - count;
  double sum = (count - mean) * v;
  double term = 2.0 * count * v;
  // Bounded: each term is less than a hundredth of the one before.
  for (double odd = 3.0;; odd += 2.0) {
    term *= v * v;
    const double next = sum + term / odd;
    if (next == sum) return sum;
    sum = next;
  }
}

/// P(X = count), by Loader's saddle-point expansion, which loses no digits for many trials.
double exactly(double count, double runs, double share) {
  const double rest = runs - count;
  double logarithm = 0.0;
  if (count == 0.0) {
    logarithm = runs * natural_logarithm(1.0 - share);
  } else if (rest == 0.0) {
    logarithm = runs * natural_logarithm(share);
  } else {
    logarithm = beyond_stirling(runs) - beyond_stirling(count) - beyond_stirling(rest) -
                deviance(count, runs * share) - deviance(rest, runs * (1.0 - share)) +
                0.5 * natural_logarithm(runs / (2.0 * std::numbers::pi * count * rest));
  }
  constexpr double kLeastExponent = -990.0;  // less is nothing beside any error that is allowed
  const double exponent = logarithm * std::numbers::log2e;
  return exponent < kLeastExponent ? 0.0 : power_of_two(exponent);
}

/// P(X <= count) for a count below the mean, where the terms fall.
double lower_tail(double count, double runs, double share) {
  double term = exactly(count, runs, share);
  double sum = term;
  // Bounded: the terms fall, and end where they no longer count.
  for (double k = count; k > 0.0; --k) {
    term *= k * (1.0 - share) / ((runs - k + 1.0) * share);
    const double next = sum + term;
    if (next == sum) break;
    sum = next;
  }
  return sum;
}

/// The share at which `tail`, which rises with it, has this value.
template <typename Tail>
double share_with(double value, const Tail& tail) {
  double low = 0.0;
  double high = 1.0;
  // Bounded: at most as many halvings as a double has digits, many more than are needed.
  for (int step = 0; step < 100; ++step) {
    const double middle = low + (high - low) / 2.0;
    if (middle <= low || middle >= high) break;
    (tail(middle) < value ? low : high) = middle;
  }
  return high;
}

}  // namespace

double at_most(std::size_t count, std::size_t runs, double share) {
  if (count >= runs) return 1.0;
  const auto k = static_cast<double>(count);
  const auto n = static_cast<double>(runs);
  if (k < n * share) return std::min(1.0, lower_tail(k, n, share));
  return std::max(0.0, 1.0 - lower_tail(n - k - 1.0, n, 1.0 - share));
}

double at_least(std::size_t count, std::size_t runs, double share) {
  if (count == 0) return 1.0;
  if (count > runs) return 0.0;
  return at_most(runs - count, runs, 1.0 - share);
}

ShareInterval clopper_pearson(std::size_t count, std::size_t runs, double confidence) {
  const double outside = (1.0 - confidence) / 2.0;
  ShareInterval interval;
  if (count > 0) {
    interval.low = share_with(outside, [&](double share) { return at_least(count, runs, share); });
  }
  if (count < runs) {
    const auto above = [&](double share) { return at_least(count + 1, runs, share); };
    interval.high = share_with(1.0 - outside, above);
  }
  return interval;
}

ShareTest::ShareTest(const ShareAim& aim, std::size_t candidates, std::size_t runs)
    : aim_(aim.share), runs_(runs) {
  std::size_t looks = 1;
  for (std::size_t look = kFirstLook; look < runs; look *= 2) ++looks;
  error_ = (1.0 - aim.confidence) / (2.0 * static_cast<double>(candidates * looks));
}

std::size_t ShareTest::next_look(std::size_t runs) const {
  std::size_t look = kFirstLook;
  while (look <= runs) look *= 2;
  return std::min(look, runs_);
}

ShareTest::Verdict ShareTest::look(std::size_t bad, std::size_t runs) const {
  if (at_most(bad, runs, aim_) <= error_) return Verdict::met;
  if (at_least(bad, runs, aim_) <= error_) return Verdict::not_met;
  return Verdict::open;
}

std::size_t ShareTest::least_runs() const {
  return static_cast<std::size_t>(std::ceil(natural_logarithm(error_) / natural_logarithm(1.0 - aim_)));
}

}  // namespace fleetplan::core
