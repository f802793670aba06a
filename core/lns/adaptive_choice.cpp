#include "core/lns/adaptive_choice.h"

#include <algorithm>
#include <array>

namespace fleetplan::core {
namespace {

/// The share of the latest try in a moving average.
constexpr double kLatestShare = 0.02;
/// An alternative without recent gain counts as if its rate were this share of the best rate.
constexpr double kLeastShare = 0.1;

}  // namespace

double AdaptiveChoice::rate(const Record& record) const { return record.gain / record.effort; }

std::vector<double> AdaptiveChoice::weights() const {
  double best = 0.0;
  for (const Record& record : records_) {
    if (record.effort > 0.0) best = std::max(best, rate(record));
  }
  std::vector<double> weights;
  weights.reserve(records_.size());
  for (const Record& record : records_) {
    // The effort, not the number of tries, is proportional to the rate.
    if (best == 0.0 || record.effort == 0.0) {
      weights.push_back(record.effort == 0.0 ? -1.0 : 1.0 / record.effort);
    } else {
      weights.push_back(std::max(rate(record), kLeastShare * best) / record.effort);
    }
  }
  const double most = *std::max_element(weights.begin(), weights.end());
  for (double& weight : weights) {
    if (weight < 0.0) weight = most > 0.0 ? most : 1.0;  // not tried yet: equal to the best
  }
  return weights;
}

std::size_t AdaptiveChoice::choose(Random& random) const {
  const std::vector<double> weights = this->weights();
  double remaining = 0.0;
  for (const double weight : weights) remaining += weight;
  remaining *= random.unit();
  for (std::size_t alternative = 0; alternative < weights.size(); ++alternative) {
    remaining -= weights[alternative];
    if (remaining < 0.0) return alternative;
  }
  return weights.size() - 1;
}

void AdaptiveChoice::learn(std::size_t alternative, double gain, double effort) {
  Record& record = records_[alternative];
  const double share = record.effort == 0.0 ? 1.0 : kLatestShare;
  record.gain += share * (gain - record.gain);
  record.effort += share * (effort - record.effort);
}

namespace {

/// The weight of a robot's earlier failures after a gain: it may gain more.
constexpr double kFailureWeightAfterGain = 0.5;

}  // namespace

std::size_t DelayedChoice::choose(const std::vector<std::size_t>& robots, const std::vector<double>& delays,
                                  Random& random) const {
  std::vector<double> weights;
  weights.reserve(robots.size());
  double remaining = 0.0;
  for (std::size_t k = 0; k < robots.size(); ++k) {
    weights.push_back(delays[k] / (1.0 + failures_[robots[k]]));
    remaining += weights.back();
  }
  remaining *= random.unit();
  for (std::size_t k = 0; k < robots.size(); ++k) {
    remaining -= weights[k];
    if (remaining < 0.0) return robots[k];
  }
  return robots.back();
}

void DelayedChoice::learn(std::size_t robot, bool gained) {
  if (gained) {
    failures_[robot] *= kFailureWeightAfterGain;
  } else {
    failures_[robot] += 1.0;
  }
}

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
