#include "core/execution/pair_dependencies.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "core/geometry/disk_motion.h"

namespace fleetplan::core {
namespace {

/// Lines whose angle has a sine of at most this are parallel: rounding.
constexpr double kParallel = 1e-12;

/// The region |offset + x along - y across| < distance, whose x is limited to an interval.
struct Section {
  Position offset;
  Position along;
  Position across;
  double distance;

  /// Returns the roots y of |offset + x along - y across| = distance for an x that has any.
  ConflictRegion::Range roots(double x) const {
    const Position w = offset + x * along;
    const double square = across.squaredNorm();
    const double beside = cross_product(w, across);
    const double half = std::sqrt(std::max(0.0, distance * distance * square - beside * beside)) / square;
    const double middle = w.dot(across) / square;
    return {middle - half, middle + half};
  }

  /// Returns the x within [from, to] at which the region has any y.
  std::optional<ConflictRegion::Range> reached_within(double from, double to) const {
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

  /// Returns the x of the least or the greatest y of the whole region, where the distance is perpendicular to
  /// `along`. `sign` selects one of the two, in no order. The lines are not parallel.
  double extreme(double sign) const {
    const double length = along.norm();
    const Position normal(-along.y() / length, along.x() / length);
    const double y = (normal.dot(offset) + sign * distance) / normal.dot(across);
    return -(offset - y * across).dot(along) / (length * length);
  }

  /// Returns the y of all points with x in [from, to], limited to [0, 1].
  std::optional<ConflictRegion::Range> extent(double from, double to) const {
    if (!(from < to)) return std::nullopt;
    if (across.squaredNorm() == 0.0) return standing(from, to);
    const auto met = reached_within(from, to);
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
  /// Returns the y if the other robot stands: all, if the line comes near it, otherwise none.
  std::optional<ConflictRegion::Range> standing(double from, double to) const {
    const double square = along.squaredNorm();
    const double nearest = square > 0.0 ? std::clamp(-offset.dot(along) / square, from, to) : from;
    return (offset + nearest * along).norm() < distance ? std::optional(ConflictRegion::Range{0.0, 1.0})
                                                        : std::nullopt;
  }
};

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

namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();
/// Rounding of the border of a region in whole progress: far above it, except on lines of some micrometres.
constexpr double kRounding = 1e-3;
constexpr std::size_t kRegionsBetweenPolls = 256;

/// Keys in a fixed order. Finds the next key that is greater than a value, in logarithmic time.
class NextGreater {
 public:
  explicit NextGreater(const std::vector<double>& keys)
      : count_(keys.size()), leaves_(std::bit_ceil(std::max<std::size_t>(1, count_))) {
    tree_.resize(2 * leaves_, -kNever);
    std::copy(keys.begin(), keys.end(), tree_.begin() + static_cast<std::ptrdiff_t>(leaves_));
    for (std::size_t node = leaves_ - 1; node > 0; --node) {
      tree_[node] = std::max(tree_[2 * node], tree_[2 * node + 1]);
    }
  }

  /// Returns the first position from `position` on whose key is greater than `value`; the number of keys if
  /// there is none.
  std::size_t from(std::size_t position, double value) const {
    if (position >= count_) return count_;
    std::size_t node = leaves_ + position;
    // Bounded: the depth of the tree, up and down.
    while (!(tree_[node] > value)) {
      while (node % 2 == 1) node /= 2;
      if (node == 0) return count_;
      ++node;
    }
    while (node < leaves_) {
      node *= 2;
      if (!(tree_[node] > value)) ++node;
    }
    return node - leaves_;
  }

 private:
  std::size_t count_;
  std::size_t leaves_;
  std::vector<double> tree_;  // the greatest key below each node
};

/// Regions, sorted by the best value that each may give. Skips regions that have no point.
class RegionOrder {
 public:
  /// Sorts regions by their least v, for the points beyond a given u.
  static RegionOrder by_second(const std::vector<PassedRegion>& regions) {
    return RegionOrder(regions, &PassedRegion::least_second, 1.0, &PassedRegion::most_first, 1.0);
  }
  /// Sorts regions by their greatest u, largest first, for the points up to a given v, which is passed as -v.
  static RegionOrder by_first(const std::vector<PassedRegion>& regions) {
    return RegionOrder(regions, &PassedRegion::most_first, -1.0, &PassedRegion::least_second, -1.0);
  }

  /// Calls visit(region) for the regions whose key is greater than `value`, until it returns false.
  template <class Visitor>
  void for_each(double value, Visitor&& visit) const {
    for (std::size_t k = keys_.from(0, value); k < order_.size(); k = keys_.from(k + 1, value)) {
      if (!visit(*order_[k])) return;
    }
  }

 private:
  using Bound = double (PassedRegion::*)() const;

  RegionOrder(const std::vector<PassedRegion>& regions, Bound rank, double rank_sign, Bound key,
              double key_sign)
      : order_(ordered(regions, rank, rank_sign)), keys_(keys_of(order_, key, key_sign)) {}

  static std::vector<const PassedRegion*> ordered(const std::vector<PassedRegion>& regions, Bound rank,
                                                  double sign) {
    std::vector<const PassedRegion*> order;
    order.reserve(regions.size());
    for (const PassedRegion& region : regions) order.push_back(&region);
    std::sort(order.begin(), order.end(), [&](const PassedRegion* a, const PassedRegion* b) {
      return sign * (a->*rank)() < sign * (b->*rank)();
    });
    return order;
  }

  static std::vector<double> keys_of(const std::vector<const PassedRegion*>& order, Bound key, double sign) {
    std::vector<double> keys;
    keys.reserve(order.size());
    for (const PassedRegion* region : order) keys.push_back(sign * (region->*key)());
    return keys;
  }

  std::vector<const PassedRegion*> order_;
  NextGreater keys_;
};

class StaircaseSearch {
 public:
  StaircaseSearch(const std::vector<PassedRegion>& regions, const Pace& first, const Pace& second,
                  double slack, const StopCondition& stop)
      : by_second_(RegionOrder::by_second(regions)),
        by_first_(RegionOrder::by_first(regions)),
        first_(first),
        second_(second),
        slack_(slack),
        stop_(stop),
        stride_(stop, kRegionsBetweenPolls) {}

  std::optional<Staircase> run() {
    for (double gate = gate_after(-1.0); gate < kNever;) {
      if (stop_.met()) return std::nullopt;
      const double t = second_.time_at(gate);
      double reached = first_.progress_at(t - slack_);
      double next = gate_after(reached);
      const double step = second_.progress_at(t + 0.5 * slack_);
      if (next < step) {
        reached = first_.progress_at(t - 0.5 * slack_);
        next = gate_after(reached);
      }
      const bool is_tight = next < step;
      if (is_tight) note_tightness(step);
      was_tight_ = is_tight;
      next = std::max(next, step);
      const double until = std::min(reached, needed_until(next));
      if (until > 0.0) found_.steps.push_back({gate, until});
      gate = next > gate ? next : kNever;
    }
    if (stride_.met()) return std::nullopt;
    return std::move(found_);
  }

 private:
  /// Returns the least v at which u must be beyond `first`.
  double gate_after(double first) {
    double least = kNever;
    by_second_.for_each(first, [&](const PassedRegion& region) {
      if (region.least_second() >= least || stride_.met_at_step()) return false;
      least = std::min(least, region.second_after(first));
      return true;
    });
    return least;
  }

  /// Returns the u that must be reached before v may be `second`.
  double needed_until(double second) {
    double most = 0.0;
    by_first_.for_each(-second, [&](const PassedRegion& region) {
      if (region.most_first() <= most || stride_.met_at_step()) return false;
      most = std::max(most, region.first_before(second));
      return true;
    });
    return most;
  }

  void note_tightness(double second) {
    const double t = second_.time_at(second);
    const double slack = std::max(0.0, t - first_.time_at(needed_until(second)));
    if (!was_tight_) {
      found_.tight.push_back({t, slack});
    } else if (slack < found_.tight.back().slack) {
      found_.tight.back() = {t, slack};
    }
  }

  RegionOrder by_second_;
  RegionOrder by_first_;
  const Pace& first_;
  const Pace& second_;
  double slack_;
  const StopCondition& stop_;
  StopStride stride_;
  bool was_tight_ = false;
  Staircase found_;
};

}  // namespace

PassedRegion::PassedRegion(const ConflictRegion& shares, const Part& first, const Part& second)
    : shares_(shares), first_(first), second_(second), most_first_(first.begin + first.length) {
  const double least = second_after(-kNever);
  const double most = first_before(kNever);
  is_open_ = least < kNever && most > -kNever;
  // Where the region has no border of its own, the border of its stretches holds, which is exact.
  least_second_ = least < kNever ? std::max(second.begin, least - kRounding) : second.begin;
  if (most > -kNever) most_first_ = std::min(most_first_, most + kRounding);
}

double PassedRegion::second_after(double first) const {
  const double from = first_.length > 0.0 ? (first - first_.begin) / first_.length : 0.0;
  const auto range = shares_.second_beyond(from);
  return range ? second_.begin + range->least * second_.length : kNever;
}

double PassedRegion::first_before(double second) const {
  const double to = second_.length > 0.0 ? (second - second_.begin) / second_.length : 1.0;
  const auto range = shares_.first_up_to(to);
  return range ? first_.begin + range->most * first_.length : -kNever;
}

std::optional<Staircase> staircase_of(const std::vector<PassedRegion>& regions, const Pace& first,
                                      const Pace& second, double slack, const StopCondition& stop) {
  if (regions.empty()) return Staircase();
  return StaircaseSearch(regions, first, second, slack, stop).run();
}

namespace {

/// The time at which two robots that follow their plans are nearest during two stretches, and their distance.
struct NearestInTime {
  double t = 0.0;
  double distance = kForever;
};

NearestInTime nearest_in_time(const MovingDisk& first, const MovingDisk& second) {
  const double begin = std::max(first.t_start, second.t_start);
  const double end = std::min(first.t_end, second.t_end);
  if (begin > end || begin == kForever) return {};
  if (first.ramp != 0.0 || second.ramp != 0.0) {
    const Approach nearest = nearest_approach(first, second);
    return {nearest.t, nearest.distance};
  }
  const Position offset = first.at(begin) - second.at(begin);
  const Position velocity = first.velocity - second.velocity;
  const double square = velocity.squaredNorm();
  const double after = square > 0.0 ? std::clamp(-offset.dot(velocity) / square, 0.0, end - begin) : 0.0;
  return {begin + after, (offset + after * velocity).norm()};
}

/// A share of a distance: a region that is smaller by this share lies beside the plan that touches its
/// border, despite rounding.
constexpr double kJustLess = 1.0 - 1e-9;

/// Seconds: two stretches that are farther apart in time than this are ordered, whatever the rounding of
/// their ends.
constexpr double kSurely = 1e-3;
constexpr std::size_t kPairsBetweenPolls = 256;

/// The regions of two robots that still matter. A region that the first robot passes first means: the second
/// robot does not enter its stretch before the first robot has left its own. If another region has a later
/// stretch of the first robot and an earlier stretch of the second one, it implies the region at all times,
/// which is then left out.
class PairRegions {
 public:
  PairRegions(const PacedRobot& first, const PacedRobot& second, double tolerance)
      : first_(first), second_(second), tolerance_(tolerance) {}

  /// Adds the regions of pairs of stretches. Returns false if the stop condition is met.
  bool add(std::span<const NearPair> near, const StopCondition& stop) {
    return add_first_goes(near, stop) && add_second_goes(near, stop);
  }

  const std::vector<PassedRegion>& first_goes() const { return first_goes_; }
  const std::vector<PassedRegion>& second_goes() const { return second_goes_; }

  /// The times at which the plan brings the two nearer than they should be.
  const std::vector<Tightness>& too_near() const { return too_near_; }

 private:
  /// Adds the regions that the first robot passes first, by ascending stretches of the second robot.
  bool add_first_goes(std::span<const NearPair> near, const StopCondition& stop) {
    std::uint32_t stretch = 0;
    std::uint32_t reached = 0;  // the last stretch of the first robot in a region with an earlier one
    std::uint32_t reached_here = 0;
    StopStride stride = StopStride::from_first(stop, kPairsBetweenPolls);
    for (std::size_t k = 0; k < near.size(); ++k) {
      if (stride.met_at_step()) return false;
      const NearPair& pair = near[k];
      if (pair.stretch != stretch) reached = std::max(reached, reached_here);
      stretch = pair.stretch;
      if (pair.other_stretch < reached) continue;
      const PlannedStretch& a = first_.stretches[pair.other_stretch];
      const PlannedStretch& b = second_.stretches[pair.stretch];
      if (is_surely_before(b, a)) continue;
      const double kept_apart = distance(a, b, &too_near_);
      const auto nearest = crossing(a, b, kept_apart);
      if (!nearest || !first_is_first(a, b, *nearest)) continue;
      first_goes_.push_back(region(a, b, kept_apart));
      if (first_goes_.back().is_open()) reached_here = std::max(reached_here, pair.other_stretch);
    }
    return true;
  }

  /// Adds the regions that the second robot passes first, by descending stretches of the second robot.
  bool add_second_goes(std::span<const NearPair> near, const StopCondition& stop) {
    constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
    std::uint32_t stretch = kNone;
    std::uint32_t entered = kNone;  // the first stretch of the first robot in a region with a later one
    std::uint32_t entered_here = kNone;
    StopStride stride = StopStride::from_first(stop, kPairsBetweenPolls);
    for (std::size_t k = 0; k < near.size(); ++k) {
      if (stride.met_at_step()) return false;
      const NearPair& pair = near[near.size() - 1 - k];
      if (pair.stretch != stretch) entered = std::min(entered, entered_here);
      stretch = pair.stretch;
      if (pair.other_stretch > entered) continue;
      const PlannedStretch& a = first_.stretches[pair.other_stretch];
      const PlannedStretch& b = second_.stretches[pair.stretch];
      if (is_surely_before(a, b)) continue;
      const double kept_apart = distance(a, b, nullptr);
      const auto nearest = crossing(a, b, kept_apart);
      if (!nearest || first_is_first(a, b, *nearest)) continue;
      second_goes_.push_back(region(b, a, kept_apart));
      if (second_goes_.back().is_open()) entered_here = std::min(entered_here, pair.other_stretch);
    }
    return true;
  }

  static bool is_surely_before(const PlannedStretch& a, const PlannedStretch& b) {
    return a.planned.t_end + kSurely < b.planned.t_start;
  }

  /// Returns the distance that the two have to keep, metres. It is less if the plan itself does not keep it;
  /// then this is noted in `too_near` (null: not noted).
  double distance(const PlannedStretch& a, const PlannedStretch& b, std::vector<Tightness>* too_near) const {
    const double wanted = a.radius + b.radius - tolerance_;
    const NearestInTime planned = nearest_in_time(MovingDisk(a.planned), MovingDisk(b.planned));
    if (planned.distance >= wanted) return wanted;
    if (too_near != nullptr) too_near->push_back({planned.t, 0.0});
    return planned.distance * kJustLess;
  }

  /// Returns where the two are nearest, if they are nearer than `distance` there.
  static std::optional<NearestShares> crossing(const PlannedStretch& a, const PlannedStretch& b,
                                               double distance) {
    if (!a.separates || !b.separates) return std::nullopt;
    const NearestShares nearest = nearest_shares(a.planned.path, b.planned.path);
    return nearest.distance < distance ? std::optional(nearest) : std::nullopt;
  }

  bool first_is_first(const PlannedStretch& a, const PlannedStretch& b, const NearestShares& nearest) const {
    if (is_surely_before(a, b)) return true;
    if (is_surely_before(b, a)) return false;
    const double u = a.begin + nearest.at.first * a.length;
    const double v = b.begin + nearest.at.second * b.length;
    return first_.pace.time_at(u) < second_.pace.time_at(v);
  }

  static PassedRegion region(const PlannedStretch& a, const PlannedStretch& b, double distance) {
    return {{a.planned.path, b.planned.path, distance}, {a.begin, a.length}, {b.begin, b.length}};
  }

  const PacedRobot& first_;
  const PacedRobot& second_;
  double tolerance_;
  std::vector<PassedRegion> first_goes_;
  std::vector<PassedRegion> second_goes_;
  std::vector<Tightness> too_near_;
};

/// Returns the entries in order of time; of several within `apart` seconds of each other, only the least one.
std::vector<Tightness> merged(std::vector<Tightness> all, double apart) {
  std::sort(all.begin(), all.end(), [](const Tightness& a, const Tightness& b) { return a.t < b.t; });
  std::vector<Tightness> kept;
  double last = 0.0;
  for (const Tightness& one : all) {
    const bool is_new = kept.empty() || one.t > last + apart;
    last = one.t;
    if (is_new) {
      kept.push_back(one);
    } else if (one.slack < kept.back().slack) {
      kept.back() = one;
    }
  }
  return kept;
}

}  // namespace

std::optional<PairDependencies> pair_dependencies(const PacedRobot& first, const PacedRobot& second,
                                                  std::span<const NearPair> near, double tolerance,
                                                  double slack, const StopCondition& stop) {
  PairRegions regions(first, second, tolerance);
  if (!regions.add(near, stop)) return std::nullopt;
  auto for_second = staircase_of(regions.first_goes(), first.pace, second.pace, slack, stop);
  auto for_first = staircase_of(regions.second_goes(), second.pace, first.pace, slack, stop);
  if (!for_second || !for_first) return std::nullopt;
  std::vector<Tightness> tight = regions.too_near();
  for (const Staircase* one : {&*for_second, &*for_first}) {
    tight.insert(tight.end(), one->tight.begin(), one->tight.end());
  }
  return PairDependencies{std::move(for_second->steps), std::move(for_first->steps),
                          merged(std::move(tight), slack)};
}

}  // namespace fleetplan::core
