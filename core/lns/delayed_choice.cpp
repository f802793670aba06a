#include "core/lns/delayed_choice.h"

namespace fleetplan::core {
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

}  // namespace fleetplan::core
