#include "core/moves/ejection_search.h"

#include <algorithm>
#include <utility>

#include "core/sipp/aa_sipp.h"

namespace fleetplan::core {
namespace {

/// The share of the robots that is ignored first.
constexpr double kFirstIgnored = 0.125;
/// A robot for which others were ejected is protected during the next call, and up to so many. With 10, two
/// robots of a crowd ejected each other for ever.
constexpr std::size_t kMaxProtectedCalls = 30;
/// A search that takes more expansions counts as failed. The next search ignores more robots.
constexpr std::int64_t kMaxEjectionExpansions = 5'000;
/// Finds paths with fewer expansions than the usual weight. They are improved later.
constexpr double kEjectionWeight = 2.0;

SearchSettings ejection_settings() {
  SearchSettings settings;
  settings.heuristic_weight = kEjectionWeight;
  settings.thorough = false;
  settings.max_expansions = kMaxEjectionExpansions;
  return settings;
}

}  // namespace

EjectionSearch::EjectionSearch(PlanState& state, Random& random, const StopCondition& stop)
    : state_(state), random_(random), stop_(stop), protected_until_(state.instance().size(), 0) {}

SearchResult EjectionSearch::plan(std::size_t robot, Robots planned, const std::vector<int>& failures) {
  ++calls_;
  sort_by_ejection(planned, failures);
  for (const std::size_t count : counts_to_ignore(planned)) {
    const Robots ignored(planned.begin(), planned.begin() + static_cast<std::ptrdiff_t>(count));
    SearchResult result = state_.plan_ignoring(robot, ignored, ejection_settings(), stop_);
    if (!result.trajectory) continue;
    protected_until_[robot] = calls_ + 2 + static_cast<std::int64_t>(random_.below(kMaxProtectedCalls));
    return eject_fewer(robot, std::move(result), planned);
  }
  return state_.plan_ignoring(robot, planned, {}, stop_);
}

/// Sorts robots by ejection: the first to be ejected come first. Equal robots are in random order.
void EjectionSearch::sort_by_ejection(Robots& planned, const std::vector<int>& failures) {
  random_.shuffle(planned);
  std::stable_sort(planned.begin(), planned.end(), [&](std::size_t a, std::size_t b) {
    return std::pair(is_protected(a), failures[a]) < std::pair(is_protected(b), failures[b]);
  });
}

/// Returns how many robots to ignore in each attempt, ascending. Protected robots are not among them.
std::vector<std::size_t> EjectionSearch::counts_to_ignore(const Robots& planned) const {
  const auto max_count = static_cast<std::size_t>(
      std::count_if(planned.begin(), planned.end(), [&](std::size_t other) { return !is_protected(other); }));
  std::vector<std::size_t> counts;
  for (double share = kFirstIgnored; share <= 1.0; share *= 2.0) {
    const auto count =
        std::min(max_count, static_cast<std::size_t>(share * static_cast<double>(planned.size())));
    if (count > (counts.empty() ? 0 : counts.back())) counts.push_back(count);
  }
  return counts;
}

/// Improves a path by conflicting with fewer robots. Tries to do without half of the robots that it conflicts
/// with, then without a quarter, and so on down to single robots. Begins with the robots at the end of
/// `planned`.
SearchResult EjectionSearch::eject_fewer(std::size_t robot, SearchResult result, const Robots& planned) {
  const Robots conflicting = state_.reservations().conflicting_robots(robot, *result.trajectory);
  Robots candidates;
  for (auto other = planned.rbegin(); other != planned.rend(); ++other) {
    if (std::binary_search(conflicting.begin(), conflicting.end(), *other)) candidates.push_back(*other);
  }
  Robots needed;
  std::size_t count = (candidates.size() + 1) / 2;
  while (!candidates.empty() && candidates.size() + needed.size() > 1 && !stop_.met()) {
    count = std::min(count, candidates.size());
    const auto rest = candidates.begin() + static_cast<std::ptrdiff_t>(count);
    Robots ignored(rest, candidates.end());
    ignored.insert(ignored.end(), needed.begin(), needed.end());
    SearchResult better = state_.plan_ignoring(robot, ignored, ejection_settings(), stop_);
    if (better.trajectory) {
      result = std::move(better);
      const Robots now = state_.reservations().conflicting_robots(robot, *result.trajectory);
      const auto is_clear = [&](std::size_t other) {
        return !std::binary_search(now.begin(), now.end(), other);
      };
      candidates.erase(candidates.begin(), rest);
      std::erase_if(candidates, is_clear);
      std::erase_if(needed, is_clear);
    } else if (count > 1) {
      count = (count + 1) / 2;
    } else {
      needed.push_back(candidates.front());
      candidates.erase(candidates.begin());
    }
  }
  return result;
}

}  // namespace fleetplan::core
