#include "core/geometry/overlap.h"

#include <algorithm>
#include <cmath>

namespace fleetplan::core {
namespace {

/// The motion of `a` relative to `b` while both last.
struct Relative {
  Relative(const MovingDisk& a, const MovingDisk& b)
      : t_begin(std::max(a.t_start, b.t_start)),
        t_end(std::min(a.t_end, b.t_end)),
        from(a.at(t_begin) - b.at(t_begin)),
        velocity(a.velocity - b.velocity),
        speed_squared(velocity.squaredNorm()) {}

  double t_begin;
  double t_end;
  Position from;  // at t_begin
  Position velocity;
  double speed_squared;
};

}  // namespace

std::optional<OverlapTime> overlap(const MovingDisk& a, const MovingDisk& b, double reach) {
  const Relative relative(a, b);
  if (relative.t_begin > relative.t_end || reach <= 0.0) return std::nullopt;
  const double excess = relative.from.squaredNorm() - reach * reach;
  if (relative.speed_squared <= 0.0 || relative.t_begin == relative.t_end) {
    if (excess >= 0.0) return std::nullopt;
    return OverlapTime{relative.t_begin, relative.t_end};
  }
  // |from + velocity s|^2 < reach^2, with s from t_begin on.
  const double half = relative.from.dot(relative.velocity);
  const double discriminant = half * half - relative.speed_squared * excess;
  if (discriminant <= 0.0) return std::nullopt;
  const double root = std::sqrt(discriminant);
  const double first = (-half - root) / relative.speed_squared;
  const double last = (-half + root) / relative.speed_squared;
  const double begin = std::max(relative.t_begin, relative.t_begin + first);
  const double end = std::min(relative.t_end, relative.t_begin + last);
  if (begin >= end) return std::nullopt;
  return OverlapTime{begin, end};
}

double least_distance(const MovingDisk& a, const MovingDisk& b) {
  const Relative relative(a, b);
  if (relative.t_begin > relative.t_end) return kForever;
  if (relative.speed_squared <= 0.0) return relative.from.norm();
  const double nearest = -relative.from.dot(relative.velocity) / relative.speed_squared;
  const double s = std::clamp(nearest, 0.0, relative.t_end - relative.t_begin);
  return (relative.from + s * relative.velocity).norm();
}

}  // namespace fleetplan::core
