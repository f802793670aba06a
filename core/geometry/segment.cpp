#include "core/geometry/segment.h"

namespace fleetplan::core {
namespace {

/// Lines whose angle has a sine of at most this are parallel: rounding.
constexpr double kParallelLines = 1e-12;

}  // namespace

NearestShares nearest_shares(const Segment& first, const Segment& second) {
  const Position d = first.to - first.from;
  const Position e = second.to - second.from;
  const Position offset = second.from - first.from;
  const double slope = cross_product(d, e);
  if (std::abs(slope) > kParallelLines * std::sqrt(d.squaredNorm() * e.squaredNorm())) {
    const double u = cross_product(offset, e) / slope;
    const double v = cross_product(offset, d) / slope;
    if (u >= 0.0 && u <= 1.0 && v >= 0.0 && v <= 1.0) return {{u, v}, 0.0};
  }
  NearestShares best{{0.0, nearest_share(second, first.from)}, 0.0};
  best.distance = (second.at(best.at.second) - first.from).norm();
  const auto improve = [&](const Shares& at) {
    const double distance = (first.at(at.first) - second.at(at.second)).norm();
    if (distance < best.distance) best = {at, distance};
  };
  improve({1.0, nearest_share(second, first.to)});
  improve({nearest_share(first, second.from), 0.0});
  improve({nearest_share(first, second.to), 1.0});
  return best;
}

}  // namespace fleetplan::core
