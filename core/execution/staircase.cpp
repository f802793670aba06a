#include "core/execution/staircase.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <limits>

namespace fleetplan::core {

namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();
/// Whole progress: far above the rounding of a region's border, except on lines of some micrometres.
constexpr double kRounding = 1e-3;
constexpr std::size_t kRegionsBetweenPolls = 256;

/// Keys in an order; finds the next one that is greater than a value, in logarithmic time.
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

  /// The first position from `position` on whose key is greater; the number of keys if there is none.
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

/// Regions by a bound of what is sought, the best one first; those that have nothing are passed over.
class RegionOrder {
 public:
  /// The regions with the least v first, among those with points beyond a u.
  static RegionOrder by_second(const std::vector<PassedRegion>& regions) {
    return RegionOrder(regions, &PassedRegion::least_second, 1.0, &PassedRegion::most_first, 1.0);
  }
  /// The regions with the greatest u first, among those with points up to a v, which is asked for as -v.
  static RegionOrder by_first(const std::vector<PassedRegion>& regions) {
    return RegionOrder(regions, &PassedRegion::most_first, -1.0, &PassedRegion::least_second, -1.0);
  }

  /// Calls visit(region) until it returns false, for regions whose key is greater than the value.
  template <class Visit>
  void for_each(double value, Visit&& visit) const {
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
  /// The least v at which u must be beyond this.
  double gate_after(double first) {
    double least = kNever;
    by_second_.for_each(first, [&](const PassedRegion& region) {
      if (region.least_second() >= least || stops()) return false;
      least = std::min(least, region.second_after(first));
      return true;
    });
    return least;
  }

  /// What u must reach before v may be at most this.
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
  // Without the region's own border, that of its stretches, which are exact.
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
