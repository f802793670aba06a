#include "core/lns/adaptive_choice.h"

#include <algorithm>

namespace fleetplan::core {
namespace {

/// Of a moving average, the share of the latest try.
constexpr double kLatest = 0.02;
/// Even a way that gained nothing lately counts like one that gained this share of what the best did.
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
    // In proportion to the rate is the effort, not the number of tries.
    if (best == 0.0 || record.effort == 0.0) {
      weights.push_back(record.effort == 0.0 ? -1.0 : 1.0 / record.effort);
    } else {
      weights.push_back(std::max(rate(record), kLeastShare * best) / record.effort);
    }
  }
  const double most = *std::max_element(weights.begin(), weights.end());
  for (double& weight : weights) {
    if (weight < 0.0) weight = most > 0.0 ? most : 1.0;  // not tried yet: as good as the best
  }
  return weights;
}

std::size_t AdaptiveChoice::choose(Random& random) const {
  const std::vector<double> weights = this->weights();
  double left = 0.0;
  for (const double weight : weights) left += weight;
  left *= random.unit();
  for (std::size_t way = 0; way < weights.size(); ++way) {
    left -= weights[way];
    if (left < 0.0) return way;
  }
  return weights.size() - 1;
}

void AdaptiveChoice::learn(std::size_t way, double gain, double effort) {
  Record& record = records_[way];
  const double share = record.effort == 0.0 ? 1.0 : kLatest;
  record.gain += share * (gain - record.gain);
  record.effort += share * (effort - record.effort);
}

}  // namespace fleetplan::core
