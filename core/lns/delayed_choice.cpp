#include "core/lns/delayed_choice.h"

namespace fleetplan::core {
namespace {

/// What a robot's failures so far still count after it gained: there may be more to gain.
constexpr double kForgiven = 0.5;

}  // namespace

std::size_t DelayedChoice::choose(const std::vector<std::size_t>& robots, const std::vector<double>& delays,
                                  Random& random) const {
  std::vector<double> weights;
  weights.reserve(robots.size());
  double left = 0.0;
  for (std::size_t k = 0; k < robots.size(); ++k) {
    weights.push_back(delays[k] / (1.0 + failures_[robots[k]]));
    left += weights.back();
  }
  left *= random.unit();
  for (std::size_t k = 0; k < robots.size(); ++k) {
    left -= weights[k];
    if (left < 0.0) return robots[k];
  }
  return robots.back();
}

void DelayedChoice::learn(std::size_t robot, bool gained) {
  if (gained) {
    failures_[robot] *= kForgiven;
  } else {
    failures_[robot] += 1.0;
  }
}

}  // namespace fleetplan::core
