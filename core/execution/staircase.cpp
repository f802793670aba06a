#include "core/execution/staircase.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

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
        stop_(stop) {}

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
    if (stopped_) return std::nullopt;
    return std::move(found_);
  }

 private:
  /// Returns the least v at which u must be beyond `first`.
  double gate_after(double first) {
    double least = kNever;
    by_second_.for_each(first, [&](const PassedRegion& region) {
      if (region.least_second() >= least || stops()) return false;
      least = std::min(least, region.second_after(first));
      return true;
    });
    return least;
  }

  /// Returns the u that must be reached before v may be `second`.
  double needed_until(double second) {
    double most = 0.0;
    by_first_.for_each(-second, [&](const PassedRegion& region) {
      if (region.most_first() <= most || stops()) return false;
      most = std::max(most, region.first_before(second));
      return true;
    });
    return most;
  }

  /// Looks at the stop condition once in many regions; stays true once it is met.
  bool stops() {
    if (++looks_ % kRegionsBetweenPolls == 0) stopped_ = stopped_ || stop_.met();
    return stopped_;
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
  std::size_t looks_ = 0;
  bool stopped_ = false;
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

}  // namespace fleetplan::core
