#include "core/geometry/disk_motion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

namespace fleetplan::core {
namespace {

/// Velocities are parallel if their cross product is below this fraction of the product of their lengths. The
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

/// A part of the motion of one disk relative to another disk, at constant relative acceleration.
struct Parabola {
  Position from{0.0, 0.0};
  Position to{0.0, 0.0};
  Position bend{0.0, 0.0};  // metres: the middle deviates from the middle of the chord by a quarter of it
  double t_begin = 0.0;
  double t_end = 0.0;

  double sag() const { return 0.25 * bend.norm(); }
  Parabola half(bool later) const {
    const Position middle = 0.5 * (from + to) - 0.25 * bend;
    const double t = 0.5 * (t_begin + t_end);
    return later ? Parabola{middle, to, 0.25 * bend, t, t_end}
                 : Parabola{from, middle, 0.25 * bend, t_begin, t};
  }
};

/// The motion of `a` relative to `b` while both last, which they do for a common time.
Parabola relative_motion(const MovingDisk& a, const MovingDisk& b) {
  const double begin = std::max(a.t_start, b.t_start);
  const double end = std::min(a.t_end, b.t_end);
  const double duration = end - begin;
  return {a.at(begin) - b.at(begin), a.at(end) - b.at(end),
          0.5 * duration * duration * (a.acceleration() - b.acceleration()), begin, end};
}

/// A parabola by the share x of its time, in [0, 1]: from + x slope + x^2 bend; and its squared distance from
/// the origin.
struct ByShare {
  explicit ByShare(const Parabola& motion)
      : from(motion.from), slope(motion.to - motion.from - motion.bend), bend(motion.bend) {}

  Position at(double x) const { return from + x * (slope + x * bend); }
  double square(double x) const { return at(x).squaredNorm(); }
  /// Half of the derivative of the square.
  double rise(double x) const { return at(x).dot(slope + 2.0 * x * bend); }
  /// Half of its second derivative: constant + 2 linear x + quadratic x^2.
  struct Curvature {
    double constant;
    double linear;
    double quadratic;
    double at(double x) const { return constant + x * (2.0 * linear + x * quadratic); }
  };
  Curvature curvature() const {
    return {slope.squaredNorm() + 2.0 * from.dot(bend), 3.0 * slope.dot(bend), 6.0 * bend.squaredNorm()};
  }

  Position from;
  Position slope;
  Position bend;
};

/// About the share at which it is nearest to the origin: the best one of a few, improved by Newton's method.
double estimated_nearest_share(const ByShare& motion) {
  constexpr int kSteps = 4;
  const ByShare::Curvature curvature = motion.curvature();
  double best = 0.0;
  double least = motion.square(0.0);
  for (const double x : {0.25, 0.5, 0.75, 1.0}) {
    const double square = motion.square(x);
    if (square < least) {
      least = square;
      best = x;
    }
  }
  for (int k = 0; k < kSteps; ++k) {
    const double bends = curvature.at(best);
    if (!(bends > 0.0)) break;
    best = std::clamp(best - motion.rise(best) / bends, 0.0, 1.0);
  }
  return best;
}

/// Whether some point of it is nearer than `reach` to the origin, if its square is convex: then that lies
/// above its tangents. None if it is not, or if that does not decide it.
std::optional<bool> convex_comes_near(const ByShare& motion, double reach) {
  const ByShare::Curvature curvature = motion.curvature();
  const bool bends = curvature.quadratic > 0.0;
  const double lowest = bends ? std::clamp(-curvature.linear / curvature.quadratic, 0.0, 1.0) : 0.0;
  if (!(curvature.at(lowest) > 0.0)) return std::nullopt;
  const double x = estimated_nearest_share(motion);
  const double square = motion.square(x);
  if (square < reach * reach) return true;
  const double rise = 2.0 * motion.rise(x);
  const double least = square + std::min(-rise * x, rise * (1.0 - x));
  return least >= reach * (reach - kParabolaError) ? std::optional(false) : std::nullopt;
}

/// Whether some point of the parabola is nearer than `reach` to the origin.
bool comes_near(const Parabola& motion, double reach) {
  const double square = reach * reach;
  if (motion.from.squaredNorm() < square || motion.to.squaredNorm() < square) return true;
  const double sag = motion.sag();
  const double distance = distance_to_segment({0.0, 0.0}, {motion.from, motion.to});
  if (distance >= reach + sag) return false;
  if (distance + sag < reach) return true;
  if (sag <= kParabolaError) return distance < reach;
  if (const auto near = convex_comes_near(ByShare(motion), reach)) return *near;
  return comes_near(motion.half(false), reach) || comes_near(motion.half(true), reach);
}

bool have_ramps(const MovingDisk& a, const MovingDisk& b) { return a.ramp != 0.0 || b.ramp != 0.0; }

/// Apart from collide(), whose every instruction counts.
[[gnu::noinline]] bool collide_with_ramps(const MovingDisk& a, const MovingDisk& b, double reach) {
  return comes_near(relative_motion(a, b), reach);
}

}  // namespace

bool collide(const MovingDisk& a, const MovingDisk& b, double reach) {
  const double begin = std::max(a.t_start, b.t_start);
  const double end = std::min(a.t_end, b.t_end);
  if (begin > end) return false;
  if (have_ramps(a, b)) [[unlikely]]
    return collide_with_ramps(a, b, reach);
  const Position q = a.at_mean_speed(begin) - b.at_mean_speed(begin);
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
  const double length = b.t_end - b.t_start;
  const UnsafeInterval x = near_zero(b.from - p, b.velocity, length, reach);
  if (b.ramp == 0.0 || x.empty()) return {b.t_start + x.begin, b.t_start + x.end};
  return {b.t_start + length * elapsed_share(x.begin / length, b.ramp),
          b.t_start + length * elapsed_share(x.end / length, b.ramp)};
}

namespace {

Position velocity_at(const MovingDisk& disk, double t) {
  const double share = (t - disk.t_start) / (disk.t_end - disk.t_start);
  return disk.velocity * (1.0 + disk.ramp * (2.0 * share - 1.0));
}

/// How near two disks pass each other, about, and how that changes if the first one departs later.
struct Passing {
  double distance = 0.0;  // metres
  double slope = 0.0;     // metres per second
};

/// The disks have a common time, or at least an instant.
Passing estimated_passing(const MovingDisk& mine, const MovingDisk& other) {
  const Parabola motion = relative_motion(mine, other);
  const ByShare by_share(motion);
  const double x = estimated_nearest_share(by_share);
  const Position gap = by_share.at(x);
  const double t = motion.t_begin + x * (motion.t_end - motion.t_begin);
  // Where my move begins or ends, the other disk is elsewhere later; at all other times, my disk is. In
  // between, both agree.
  const bool is_at_my_end = (x == 0.0 && mine.t_start >= other.t_start) ||  //
                            (x == 1.0 && mine.t_end <= other.t_end);
  const Position speed = is_at_my_end ? velocity_at(other, t) : velocity_at(mine, t);
  return {gap.norm(), -gap.dot(speed) / gap.norm()};
}

/// An estimate of the departure from which on the disks no longer collide, between a departure at which they
/// collide and one at which they do not. By Newton's method. None if it does not lead there.
std::optional<double> estimated_end_of_collisions(double inside, double outside, double reach,
                                                  MovingDisk mine, const MovingDisk& other) {
  constexpr int kMaxSteps = 8;
  const double duration = mine.t_end - mine.t_start;
  const auto passing_at = [&](double t) {
    mine.t_start = t;
    mine.t_end = t + duration;
    return estimated_passing(mine, other);
  };
  const double near = passing_at(inside).distance;
  const double far = passing_at(outside).distance;
  if (!(near < reach && reach < far)) return std::nullopt;
  double t = inside + (reach - near) / (far - near) * (outside - inside);
  for (int k = 0; k < kMaxSteps; ++k) {
    const Passing passing = passing_at(t);
    const double step = (reach - passing.distance) / passing.slope;
    t += step;
    if (!(std::min(inside, outside) < t && t < std::max(inside, outside))) return std::nullopt;
    if (std::abs(step) < 0.1 * kDepartureError) return t;
  }
  return std::nullopt;
}

/// The end of a collision, up to kDepartureError, on the way from `inside`, where `collides` is true, to
/// `outside`. Rounded away from `inside`. If it still collides at `outside`, returns `outside`. An estimate
/// makes most of the bisection unnecessary.
template <class Collides>
double end_of_collisions(double inside, double outside, std::optional<double> estimate,
                         const Collides& collides) {
  if (collides(outside)) return outside;
  if (estimate) {
    const double half = std::copysign(0.5 * kDepartureError, outside - inside);
    if (collides(*estimate + half)) {
      inside = *estimate + half;
    } else {
      outside = *estimate + half;
      if (collides(*estimate - half)) inside = *estimate - half;
    }
  }
  while (std::abs(outside - inside) > kDepartureError) {
    const double middle = 0.5 * (inside + outside);
    if (middle == inside || middle == outside) break;
    (collides(middle) ? inside : outside) = middle;
  }
  return outside;
}

/// See the head of disk_motion.h.
UnsafeInterval forbidden_departures_with_ramps(MovingDisk mine, double duration, const MovingDisk& b,
                                               double reach) {
  const double length = b.t_end - b.t_start;
  const auto my_time = [&](double share) { return duration * elapsed_share(share, mine.ramp); };
  if (b.velocity.squaredNorm() == 0.0) {
    const UnsafeInterval s = near_zero(mine.from - b.from, mine.velocity, duration, reach);
    if (s.empty()) return {};
    return {b.t_start - my_time(s.end / duration), b.t_end - my_time(s.begin / duration)};
  }
  const Segment path{mine.from, mine.from + mine.velocity * duration};
  const Segment its_path{b.from, b.from + b.velocity * length};
  const NearestShares nearest = nearest_shares(path, its_path);
  if (nearest.distance >= reach) return {};
  mine.t_end = mine.t_start + duration;
  const auto collides = [&](double t) {
    mine.t_start = t;
    mine.t_end = t + duration;
    return collide(mine, b, reach);
  };
  const double inside =
      b.t_start + length * elapsed_share(nearest.at.second, b.ramp) - my_time(nearest.at.first);
  const auto end_towards = [&](double outside) {
    return end_of_collisions(inside, outside, estimated_end_of_collisions(inside, outside, reach, mine, b),
                             collides);
  };
  return {end_towards(b.t_start - duration), end_towards(b.t_end)};
}

}  // namespace

UnsafeInterval forbidden_departures(const Position& from, const Position& velocity, double duration,
                                    const MovingDisk& b, double reach, double ramp) {
  if (ramp != 0.0 || b.ramp != 0.0) {
    MovingDisk mine;
    mine.from = from;
    mine.velocity = velocity;
    mine.ramp = ramp;
    return forbidden_departures_with_ramps(mine, duration, b, reach);
  }
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

/// The motion of `a` relative to `b` while both last, at constant speed.
struct Relative {
  Relative(const MovingDisk& a, const MovingDisk& b)
      : t_begin(std::max(a.t_start, b.t_start)),
        t_end(std::min(a.t_end, b.t_end)),
        from(a.at_mean_speed(t_begin) - b.at_mean_speed(t_begin)),
        velocity(a.velocity - b.velocity),
        speed_squared(velocity.squaredNorm()) {}

  double t_begin;
  double t_end;
  Position from;  // at t_begin
  Position velocity;
  double speed_squared;
};

/// Where a function changes its sign between two shares, the first of which `is_before` that.
template <class IsBefore>
double change_between(double first, double last, const IsBefore& is_before) {
  constexpr int kHalvings = 60;  // more digits than a share in [0, 1] has
  for (int k = 0; k < kHalvings; ++k) {
    const double middle = 0.5 * (first + last);
    (is_before(middle) ? first : last) = middle;
  }
  return last;
}

/// Where the squared distance of a parabola from the origin is least, or passes a value, by the share of its
/// time.
class SquaredDistance {
 public:
  explicit SquaredDistance(const Parabola& motion) : motion_(motion) { add_extrema(); }

  double at(double x) const { return motion_.square(x); }

  double nearest_share() const {
    return *std::min_element(borders_.begin(), borders_.begin() + count_,
                             [&](double x, double y) { return at(x) < at(y); });
  }

  /// The first share at which it is below a value, up to rounding; none if it never is.
  std::optional<double> first_below(double value) const {
    if (at(0.0) < value) return 0.0;
    for (std::ptrdiff_t k = 1; k < count_; ++k) {
      if (at(borders_[k]) >= value) continue;
      return change_between(borders_[k - 1], borders_[k], [&](double x) { return at(x) >= value; });
    }
    return std::nullopt;
  }

 private:
  /// Its derivative, a cubic, has at most one root on each side of its own extrema.
  void add_extrema() {
    const auto [c, b, a] = motion_.curvature();
    std::array<double, 4> parts{0.0, 0.0, 0.0, 1.0};
    const double discriminant = b * b - a * c;
    if (discriminant > 0.0) {
      const double q = -(b + std::copysign(std::sqrt(discriminant), b));
      const auto within = [](double x) { return x > 0.0 && x < 1.0 ? x : 0.0; };  // 0 without such a root
      parts[1] = within(q / a);
      parts[2] = within(c / q);
      if (parts[1] > parts[2]) std::swap(parts[1], parts[2]);
    }
    for (std::size_t k = 1; k < parts.size(); ++k) {
      const bool falls = motion_.rise(parts[k - 1]) < 0.0;
      if (falls == (motion_.rise(parts[k]) < 0.0)) continue;
      const auto is_before = [&](double x) { return (motion_.rise(x) < 0.0) == falls; };
      borders_[count_++] = change_between(parts[k - 1], parts[k], is_before);
    }
    borders_[count_++] = 1.0;
  }

  ByShare motion_;
  /// It is monotone between two of the first `count_`, which ascend from 0 to 1.
  std::array<double, 5> borders_{};
  std::ptrdiff_t count_ = 1;
};

/// The first time at which the parabola is nearer than `reach` to the origin or, going back, the last one.
std::optional<double> first_near(const Parabola& motion, double reach, bool back) {
  const Parabola way =
      back ? Parabola{motion.to, motion.from, motion.bend, motion.t_end, motion.t_begin} : motion;
  const auto share = SquaredDistance(way).first_below(reach * reach);
  return share ? std::optional(way.t_begin + *share * (way.t_end - way.t_begin)) : std::nullopt;
}

}  // namespace

Approach nearest_approach(const MovingDisk& a, const MovingDisk& b) {
  const Parabola motion = relative_motion(a, b);
  const SquaredDistance distance(motion);
  const double share = distance.nearest_share();
  return {motion.t_begin + share * (motion.t_end - motion.t_begin), std::sqrt(distance.at(share))};
}

std::optional<OverlapTime> overlap(const MovingDisk& a, const MovingDisk& b, double reach) {
  if (have_ramps(a, b)) {
    if (std::max(a.t_start, b.t_start) > std::min(a.t_end, b.t_end) || reach <= 0.0) return std::nullopt;
    const Parabola motion = relative_motion(a, b);
    const auto begin = first_near(motion, reach, false);
    const auto end = first_near(motion, reach, true);
    if (!begin || !end || *begin >= *end) return std::nullopt;
    return OverlapTime{*begin, *end};
  }
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
  if (have_ramps(a, b)) return nearest_approach(a, b).distance;
  if (relative.speed_squared <= 0.0) return relative.from.norm();
  const double nearest = -relative.from.dot(relative.velocity) / relative.speed_squared;
  const double s = std::clamp(nearest, 0.0, relative.t_end - relative.t_begin);
  return (relative.from + s * relative.velocity).norm();
}

}  // namespace fleetplan::core
