#include "core/lns/adaptive_choice.h"

#include <algorithm>

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

}  // namespace fleetplan::core
