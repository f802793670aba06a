#include "core/execution/conflict_region.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace fleetplan::core {

namespace {

/// Sines of angles between lines up to this are those of parallel lines: rounding.
constexpr double kParallel = 1e-12;

/// The region |offset + x along - y across| < distance, of which x is cut to an interval.
struct Section {
  Position offset;
  Position along;
  Position across;
  double distance;

  /// The roots y of |offset + x along - y across| = distance, for an x at which there are any.
  ConflictRegion::Range roots(double x) const {
    const Position w = offset + x * along;
    const double square = across.squaredNorm();
    const double beside = cross_product(w, across);
    const double half = std::sqrt(std::max(0.0, distance * distance * square - beside * beside)) / square;
    const double middle = w.dot(across) / square;
    return {middle - half, middle + half};
  }

  /// The x within [from, to] at which the line across meets the region.
  std::optional<ConflictRegion::Range> meeting(double from, double to) const {
    const double reach = distance * across.norm();
    const double at_zero = cross_product(offset, across);
    const double slope = cross_product(along, across);
    if (std::abs(slope) <= kParallel * along.norm() * across.norm()) {
      return std::abs(at_zero) < reach ? std::optional(ConflictRegion::Range{from, to}) : std::nullopt;
    }
    const auto [low, high] = std::minmax({(-reach - at_zero) / slope, (reach - at_zero) / slope});
    const ConflictRegion::Range met{std::max(from, low), std::min(to, high)};
    return met.least < met.most ? std::optional(met) : std::nullopt;
  }

  /// The x at which the least or the greatest y of the whole region is: there the distance is perpendicular
  /// to `along`. `sign` tells the two apart, in no order. Not for parallel lines.
  double extreme(double sign) const {
    const double length = along.norm();
    const Position normal(-along.y() / length, along.x() / length);
    const double y = (normal.dot(offset) + sign * distance) / normal.dot(across);
    return -(offset - y * across).dot(along) / (length * length);
  }

  /// The y of all points with x in [from, to], cut to [0, 1].
  std::optional<ConflictRegion::Range> extent(double from, double to) const {
    if (!(from < to)) return std::nullopt;
    if (across.squaredNorm() == 0.0) return standing(from, to);
    const auto met = meeting(from, to);
    if (!met) return std::nullopt;
    ConflictRegion::Range found = roots(met->least);
    const auto include = [&](double x) {
      const ConflictRegion::Range here = roots(std::clamp(x, met->least, met->most));
      found = {std::min(found.least, here.least), std::max(found.most, here.most)};
    };
    include(met->most);
    if (std::abs(cross_product(along, across)) > kParallel * along.norm() * across.norm()) {
      include(extreme(-1.0));
      include(extreme(1.0));
    }
    found = {std::max(0.0, found.least), std::min(1.0, found.most)};
    return found.least < found.most ? std::optional(found) : std::nullopt;
  }

 private:
  /// The other robot stands: any y, if the line comes near it at all.
  std::optional<ConflictRegion::Range> standing(double from, double to) const {
    const double square = along.squaredNorm();
    const double nearest = square > 0.0 ? std::clamp(-offset.dot(along) / square, from, to) : from;
    return (offset + nearest * along).norm() < distance ? std::optional(ConflictRegion::Range{0.0, 1.0})
                                                        : std::nullopt;
  }
};

Position point_at(const Segment& segment, double share) {
  return segment.from + share * (segment.to - segment.from);
}

}  // namespace

ConflictRegion::ConflictRegion(const Segment& first, const Segment& second, double distance)
    : offset_(first.from - second.from),
      first_(first.to - first.from),
      second_(second.to - second.from),
      distance_(distance) {}

std::optional<ConflictRegion::Range> ConflictRegion::second_beyond(double from) const {
  return Section{offset_, first_, second_, distance_}.extent(std::max(0.0, from), 1.0);
}

std::optional<ConflictRegion::Range> ConflictRegion::first_up_to(double to) const {
  return Section{-offset_, second_, first_, distance_}.extent(0.0, std::min(1.0, to));
}

NearestShares nearest_shares(const Segment& first, const Segment& second) {
  const Position d = first.to - first.from;
  const Position e = second.to - second.from;
  const Position offset = second.from - first.from;
  const double slope = cross_product(d, e);
  if (slope != 0.0) {
    const double u = cross_product(offset, e) / slope;
    const double v = cross_product(offset, d) / slope;
    if (u >= 0.0 && u <= 1.0 && v >= 0.0 && v <= 1.0) return {{u, v}, 0.0};
  }
  NearestShares best{{0.0, nearest_share(second, first.from)}, 0.0};
  best.distance = (point_at(second, best.at.second) - first.from).norm();
  const auto improve = [&](const Shares& at) {
    const double distance = (point_at(first, at.first) - point_at(second, at.second)).norm();
    if (distance < best.distance) best = {at, distance};
  };
  improve({1.0, nearest_share(second, first.to)});
  improve({nearest_share(first, second.from), 0.0});
  improve({nearest_share(first, second.to), 1.0});
  return best;
}

}  // namespace fleetplan::core
