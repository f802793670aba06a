#include "core/execution/implied_dependencies.h"

#include <algorithm>
#include <tuple>
#include <utility>

namespace fleetplan::core {

namespace {

/// Each takes two searches in a sorted list.
constexpr std::size_t kComparisonsBetweenPolls = 256;

/// The dependencies of one robot on another: a range of the list.
struct PairRange {
  std::size_t waits = 0;
  std::size_t leads = 0;
  std::size_t begin = 0;
  std::size_t end = 0;
};

class Implications {
 public:
  explicit Implications(std::vector<WholeDependency> all) : all_(std::move(all)) {
    std::stable_sort(all_.begin(), all_.end(), [](const WholeDependency& a, const WholeDependency& b) {
      return std::tie(a.waits, a.leads) < std::tie(b.waits, b.leads);
    });
    for (std::size_t k = 0; k < all_.size(); ++k) {
      const bool is_same =
          !pairs_.empty() && pairs_.back().waits == all_[k].waits && pairs_.back().leads == all_[k].leads;
      if (!is_same) pairs_.push_back({all_[k].waits, all_[k].leads, k, k});
      pairs_.back().end = k + 1;
    }
  }

  const std::vector<WholeDependency>& all() const { return all_; }
  const std::vector<PairRange>& pairs() const { return pairs_; }

  /// The pairs in which this robot waits.
  std::pair<std::size_t, std::size_t> waiting(std::size_t robot) const {
    const auto begin = std::lower_bound(pairs_.begin(), pairs_.end(), robot,
                                        [](const PairRange& pair, std::size_t r) { return pair.waits < r; });
    auto end = begin;
    while (end != pairs_.end() && end->waits == robot) ++end;
    return {static_cast<std::size_t>(begin - pairs_.begin()), static_cast<std::size_t>(end - pairs_.begin())};
  }

  /// Whether the dependency follows from two others, of which the first is on a robot of `neighbours`.
  bool is_implied(const WholeDependency& one, std::pair<std::size_t, std::size_t> neighbours) const {
    for (std::size_t k = neighbours.first; k < neighbours.second; ++k) {
      if (pairs_[k].leads == one.leads) continue;
      // The last one of this pair whose gate comes first.
      const WholeDependency* between =
          last_in(pairs_[k], [&](const WholeDependency& other) { return other.gate <= one.gate; });
      if (between == nullptr || between->t_until <= one.t_until) continue;
      if (reaches(between->leads, between->until, one)) return true;
    }
    return false;
  }

 private:
  template <class Holds>
  const WholeDependency* last_in(const PairRange& pair, const Holds& holds) const {
    const auto begin = all_.begin() + static_cast<std::ptrdiff_t>(pair.begin);
    const auto end = all_.begin() + static_cast<std::ptrdiff_t>(pair.end);
    const auto after = std::partition_point(begin, end, holds);
    return after == begin ? nullptr : &*(after - 1);
  }

  /// Whether the robot in the middle can only have made this progress after `one` is met.
  bool reaches(std::size_t middle, double progress, const WholeDependency& one) const {
    const auto pair = std::lower_bound(
        pairs_.begin(), pairs_.end(), std::pair(middle, one.leads),
        [](const PairRange& range, const auto& key) { return std::pair(range.waits, range.leads) < key; });
    if (pair == pairs_.end() || pair->waits != middle || pair->leads != one.leads) return false;
    const WholeDependency* second =
        last_in(*pair, [&](const WholeDependency& other) { return other.gate < progress; });
    return second != nullptr && second->until >= one.until;
  }

  std::vector<WholeDependency> all_;
  std::vector<PairRange> pairs_;
};

}  // namespace

std::optional<std::vector<WholeDependency>> without_implied(std::vector<WholeDependency> all,
                                                            const StopCondition& stop) {
  std::vector<WholeDependency> kept;
  std::size_t comparisons = 0;
  const Implications implications(std::move(all));
  for (const PairRange& pair : implications.pairs()) {
    const auto neighbours = implications.waiting(pair.waits);
    for (std::size_t k = pair.begin; k < pair.end; ++k) {
      const WholeDependency& one = implications.all()[k];
      comparisons += 1 + neighbours.second - neighbours.first;
      if (comparisons >= kComparisonsBetweenPolls) {
        if (stop.met()) return std::nullopt;
        comparisons = 0;
      }
      if (!implications.is_implied(one, neighbours)) kept.push_back(one);
    }
  }
  return kept;
}

}  // namespace fleetplan::core
