#include "core/geometry/disk_motion.h"

#include <algorithm>
#include <cmath>

namespace fleetplan::core {
namespace {

/// Velocities are parallel if their cross product is below this fraction of the product of their lengths: the
/// extreme points of the ellipse then lie outside any rectangle that can occur.
constexpr double kParallel = 1e-12;

/// The part of [0, length] on which |q + v x| < reach; empty if there is none.
UnsafeInterval near_zero(const Position& q, const Position& v, double length, double reach) {
  const double qq = q.squaredNorm() - reach * reach;
  const double vv = v.squaredNorm();
  if (vv == 0.0) return qq < 0.0 ? UnsafeInterval{0.0, length} : UnsafeInterval{};
  const double qv = q.dot(v);
  // The distance of the line from the origin, by the cross product: no cancellation far away from the origin.
  const double c = cross_product(q, v);
  const double discriminant = reach * reach * vv - c * c;
  if (discriminant <= 0.0) return {};
  const double half = std::sqrt(discriminant);
  return {std::max(0.0, (-qv - half) / vv), std::min(length, (-qv + half) / vv)};
}

/// Collects the extreme values of the departure offset u - s over the clipped region.
class Extent {
 public:
  void add(double w) {
    begin_ = std::min(begin_, w);
    end_ = std::max(end_, w);
  }
  UnsafeInterval shifted(double t0) const { return {begin_ + t0, end_ + t0}; }

 private:
  double begin_ = kForever;
  double end_ = -kForever;
};

}  // namespace

bool collide(const MovingDisk& a, const MovingDisk& b, double reach) {
  const double begin = std::max(a.t_start, b.t_start);
  const double end = std::min(a.t_end, b.t_end);
  if (begin > end) return false;
  const Position q = a.at(begin) - b.at(begin);
  const Position v = a.velocity - b.velocity;
  const double qq = q.squaredNorm();
  const double rr = reach * reach;
  if (qq < rr) return true;
  const double qv = q.dot(v);
  if (qv >= 0.0) return false;  // moving apart, or no relative motion
  const double vv = v.squaredNorm();
  const double length = end - begin;
  if (-qv < vv * length) {  // closest between the two ends
    const double c = cross_product(q, v);
    return c * c < rr * vv;
  }
  return (q + v * length).squaredNorm() < rr;
}

UnsafeInterval unsafe_interval(const Position& p, const MovingDisk& b, double reach) {
  const UnsafeInterval x = near_zero(b.from - p, b.velocity, b.t_end - b.t_start, reach);
  return {b.t_start + x.begin, b.t_start + x.end};
}

UnsafeInterval forbidden_departures(const Position& from, const Position& velocity, double duration,
                                    const MovingDisk& b, double reach) {
  const Position q = from - b.from;
  const double length = b.t_end - b.t_start;
  Extent extent;
  // The four edges of the rectangle; an edge with a collision includes the rectangle's corners that collide.
  if (const auto u = near_zero(q, -b.velocity, length, reach); !u.empty()) {  // s = 0
    extent.add(u.begin);
    extent.add(u.end);
  }
  const Position arrived = q + velocity * duration;
  if (const auto u = near_zero(arrived, -b.velocity, length, reach); !u.empty()) {  // s = d
    extent.add(u.begin - duration);
    extent.add(u.end - duration);
  }
  if (const auto s = near_zero(q, velocity, duration, reach); !s.empty()) {  // u = 0
    extent.add(-s.end);
    extent.add(-s.begin);
    if (length == kForever) extent.add(kForever);  // a wait without end blocks later departures, too
  }
  if (length == kForever) return extent.shifted(b.t_start);  // no fourth edge, no ellipse
  const Position ended = q - b.velocity * length;
  if (const auto s = near_zero(ended, velocity, duration, reach); !s.empty()) {  // u = L
    extent.add(length - s.end);
    extent.add(length - s.begin);
  }
  // The ellipse's extreme points: offsets w whose relative path is a tangent of the disk.
  const Position relative = velocity - b.velocity;
  const double vv = relative.squaredNorm();
  const double turn = cross_product(b.velocity, velocity);
  if (std::abs(turn) > kParallel * std::sqrt(velocity.squaredNorm() * b.velocity.squaredNorm())) {
    for (const double side : {-reach, reach}) {
      const double w = (cross_product(q, relative) + side * std::sqrt(vv)) / turn;
      const double s = (b.velocity * w - q).dot(relative) / vv;
      const double u = s + w;
      if (s >= 0.0 && s <= duration && u >= 0.0 && u <= length) extent.add(w);
    }
  }
  return extent.shifted(b.t_start);
}

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
