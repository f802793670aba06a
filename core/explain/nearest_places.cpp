#include "core/explain/nearest_places.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/geometry/elementary_functions.h"

namespace fleetplan::core {
namespace {

/// The most places that are tested for one disk and for all of them.
constexpr std::size_t kMaxPlacesOfOne = 8'000;
constexpr std::size_t kMaxPlaces = 40'000;
/// Places are searched on circles about the disk. Each circle is so much larger than the circle before.
constexpr double kGrowth = 1.05;
constexpr double kLeastGrowth = 1e-3;  // metres
constexpr int kDirections = 64;
/// How far the farthest place is, metres, and in radii.
constexpr double kFarthest = 2.0;
constexpr double kFarthestRadii = 4.0;
/// Halvings of the way between two circles.
constexpr int kHalvingsOfSide = 24;
/// Added to a distance, so that rounding closes no contact, metres.
constexpr double kSlack = 1e-9;
/// How much farther a place may be that has fewer decimals, metres.
constexpr double kForFewerDecimals = 0.01;
/// Places of 2 to 6 decimals, as numbers of them in a metre.
constexpr std::array kInAMetre{1e2, 1e3, 1e4, 1e5, 1e6};

Position direction(int index) {
  const double angle = 2.0 * std::numbers::pi * index / kDirections;
  return unit_vector(angle);
}

}  // namespace

bool NearestPlaces::fits(const LineOfSight& sight, const Position& place, double radius) {
  ++tests_;
  stride_.met_at_step();
  return sight.disk_fits(place, radius);
}

std::optional<Position> NearestPlaces::of(const LineOfSight& sight, const Position& from, double radius,
                                          double overlap) {
  const std::size_t max_tests = std::min(tests_ + kMaxPlacesOfOne, kMaxPlaces);
  const double farthest = std::max(kFarthest, kFarthestRadii * radius);
  double below = overlap;
  // Bounded: kMaxPlacesOfOne, and the stop condition.
  for (double distance = overlap + kSlack; distance <= farthest;
       distance = std::max(kGrowth * distance, distance + kLeastGrowth)) {
    std::optional<Position> nearest;
    double shortest = distance;
    for (int index = 0; index < kDirections; ++index) {
      if (tests_ >= max_tests || stride_.met()) return std::nullopt;
      if (!fits(sight, from + distance * direction(index), radius)) continue;
      double open = distance;
      double closed = below;
      for (int k = 0; k < kHalvingsOfSide && open - closed > kSlack; ++k) {
        const double middle = 0.5 * (open + closed);
        (fits(sight, from + middle * direction(index), radius) ? open : closed) = middle;
      }
      if (nearest && open >= shortest - kSlack) continue;
      shortest = open;
      nearest = from + open * direction(index);
    }
    if (nearest) return with_few_decimals(sight, from, *nearest, radius);
    below = distance;
  }
  return std::nullopt;
}

std::optional<Position> NearestPlaces::with_few_decimals(const LineOfSight& sight, const Position& from,
                                                         const Position& place, double radius) {
  const Position world = place + origin_;
  const double farthest = (place - from).norm() + kForFewerDecimals;
  // Bounded: four places for each number of decimals.
  for (const double unit : kInAMetre) {
    std::optional<Position> best;
    for (const int x : {0, 1}) {
      for (const int y : {0, 1}) {
        const Position rounded((std::floor(world.x() * unit) + x) / unit,
                               (std::floor(world.y() * unit) + y) / unit);
        const Position candidate = rounded - origin_;
        const double distance = (candidate - from).norm();
        if (distance > farthest || (best && distance >= (*best - from).norm())) continue;
        if (fits(sight, candidate, radius)) best = candidate;
      }
    }
    if (best) return best;
  }
  return std::nullopt;
}

}  // namespace fleetplan::core
