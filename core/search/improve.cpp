#include "core/search/improve.h"

#include <algorithm>
#include <array>
#include <utility>

#include "core/search/adaptive_choice.h"
#include "core/search/neighbourhood.h"
#include "core/search/reroute.h"

namespace fleetplan::core {
namespace {

/// A delay below this is rounding, seconds.
constexpr double kLeastDelay = 1e-9;
constexpr std::array<std::size_t, 5> kSizes{1, 2, 4, 8, 16};
/// How hard to search. Greedy searches with few expansions find most of what can be found, and fail soon;
/// the others are for what is left.
constexpr std::array<SearchLimits, 3> kEfforts{{
    {.greed = 1.5, .thorough = false, .max_expansions = 400},
    {.greed = 1.5, .thorough = false, .max_expansions = 8'000},
    {.greed = 1.0,
     .suboptimality = 0.0,
     .impatience = 0.0,
     .coarseness = 0.0,
     .thorough = false,
     .max_expansions = 40'000},
}};
/// What a search costs before its first expansion, in expansions.
constexpr double kSearchEffort = 20.0;

class Improving {
 public:
  Improving(FleetState& state, std::vector<std::size_t> planned, const TautBounds& bounds, Random& random,
            const StopCondition& stop)
      : state_(state),
        for_makespan_(state.fleet().options().objective == PlanOptions::Objective::makespan),
        planned_(std::move(planned)),
        bounds_(bounds),
        random_(random),
        stop_(stop),
        neighbourhoods_(state, planned_, stop) {}

  Improvement run(std::optional<std::int64_t> max_iterations) {
    Improvement result;
    for (std::int64_t i = 0; !max_iterations || i < *max_iterations; ++i) {
      if (at_lower_bound()) return result;
      if (stop_.met()) {
        result.cut_off = true;
        return result;
      }
      if (iterate()) ++result.improvements;
    }
    result.cut_off = stop_.met();  // perhaps in the last iteration
    return result;
  }

 private:
  double cost(std::size_t robot) const { return state_.trajectory(robot)->cost; }
  double delay(std::size_t robot) const { return std::max(0.0, cost(robot) - bounds_[robot]); }

  bool at_lower_bound() const {
    if (planned_.empty()) return true;
    if (for_makespan_) {
      const auto by_bound = [&](std::size_t a, std::size_t b) { return bounds_[a] < bounds_[b]; };
      const std::size_t last = *std::max_element(planned_.begin(), planned_.end(), by_bound);
      return cost(last_to_arrive()) <= bounds_[last] + kLeastDelay;
    }
    return std::all_of(planned_.begin(), planned_.end(),
                       [&](std::size_t robot) { return delay(robot) <= kLeastDelay; });
  }

  std::size_t last_to_arrive() const {
    return *std::max_element(planned_.begin(), planned_.end(),
                             [&](std::size_t a, std::size_t b) { return cost(a) < cost(b); });
  }

  /// A delayed robot, more likely the more delayed it is.
  std::size_t choose_delayed() {
    double left = 0.0;
    for (const std::size_t robot : planned_) left += delay(robot);
    left *= random_.unit();
    for (const std::size_t robot : planned_) {
      left -= delay(robot);
      if (left < 0.0) return robot;
    }
    return planned_.back();
  }

  /// True if the plan became better.
  bool iterate() {
    const std::size_t kind = kinds_.choose(random_);
    const std::size_t size = sizes_.choose(random_);
    const std::size_t effort = efforts_.choose(random_);
    Aim aim{Aim::Gain::sum, kForever, kEfforts[effort]};
    std::size_t first = 0;
    if (for_makespan_) {
      first = last_to_arrive();
      aim.ceiling = cost(first);
      if (random_.below(2) == 0) {
        aim.gain = Aim::Gain::first;
      } else {
        first = choose_delayed();
      }
    } else {
      first = choose_delayed();
    }
    const std::vector<std::size_t> robots =
        neighbourhoods_.around(first, static_cast<Neighbourhood>(kind), kSizes[size], random_);
    const std::int64_t before = state_.expansions();
    Rerouting rerouting = reroute(state_, robots, bounds_, aim, stop_);
    const double gain = rerouting.change ? rerouting.change->gain : 0.0;
    const double spent = static_cast<double>(state_.expansions() - before) +
                         kSearchEffort * static_cast<double>(rerouting.searches);
    kinds_.learn(kind, gain, spent);
    sizes_.learn(size, gain, spent);
    efforts_.learn(effort, gain, spent);
    if (!rerouting.change) return false;
    apply(state_, std::move(*rerouting.change));
    return true;
  }

  FleetState& state_;
  bool for_makespan_;
  std::vector<std::size_t> planned_;
  const TautBounds& bounds_;
  Random& random_;
  const StopCondition& stop_;
  Neighbourhoods neighbourhoods_;
  AdaptiveChoice kinds_{kNeighbourhoods};
  AdaptiveChoice sizes_{kSizes.size()};
  AdaptiveChoice efforts_{kEfforts.size()};
};

}  // namespace

Improvement improve(FleetState& state, const std::vector<std::size_t>& movers, const TautBounds& bounds,
                    Random& random, const StopCondition& stop) {
  std::vector<std::size_t> planned;
  for (const std::size_t robot : movers) {
    if (state.trajectory(robot)) planned.push_back(robot);
  }
  return Improving(state, std::move(planned), bounds, random, stop)
      .run(state.fleet().options().max_iterations);
}

}  // namespace fleetplan::core
