#include "core/lns/adaptive_parameters.h"

#include <array>

namespace fleetplan::core {
namespace {

constexpr std::array<std::size_t, 5> kSizes{1, 2, 4, 8, 16};
/// Weighted searches with few expansions find most of what can be found, and fail soon; the others are for
/// what is left.
constexpr std::array<SearchLimits, 3> kLimits{{
    {.heuristic_weight = 1.5, .thorough = false, .max_expansions = 400},
    {.heuristic_weight = 1.5, .thorough = false, .max_expansions = 8'000},
    {.heuristic_weight = 1.0,
     .suboptimality = 0.0,
     .suboptimality_growth = 0.0,
     .dominance_slack = 0.0,
     .thorough = false,
     .max_expansions = 40'000},
}};
/// The effort of a search before its first expansion, in expansions.
constexpr double kSearchEffort = 20.0;

}  // namespace

std::size_t AdaptiveParameters::Choice::robots() const { return kSizes[size]; }

const SearchLimits& AdaptiveParameters::Choice::search_limits() const { return kLimits[limits]; }

AdaptiveParameters::AdaptiveParameters()
    : kinds_(kNeighbourhoods), sizes_(kSizes.size()), limits_(kLimits.size()) {}

AdaptiveParameters::Choice AdaptiveParameters::choose(Random& random) const {
  Choice choice;
  choice.kind = kinds_.choose(random);
  choice.size = sizes_.choose(random);
  choice.limits = limits_.choose(random);
  return choice;
}

void AdaptiveParameters::learn(const Choice& choice, double gain, std::int64_t searches,
                               std::int64_t expansions) {
  const double effort = static_cast<double>(expansions) + kSearchEffort * static_cast<double>(searches);
  kinds_.learn(choice.kind, gain, effort);
  sizes_.learn(choice.size, gain, effort);
  limits_.learn(choice.limits, gain, effort);
}

}  // namespace fleetplan::core
