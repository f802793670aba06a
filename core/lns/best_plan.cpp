#include "core/lns/best_plan.h"

#include <utility>

namespace fleetplan::core {
namespace {

/// A difference of costs below this is rounding, seconds.
constexpr double kRounding = 1e-9;

}  // namespace

void BestPlan::replace(std::size_t robot, Trajectory trajectory) {
  differences_.try_emplace(robot, incumbent_.trajectory(robot));
  incumbent_.replace(robot, std::move(trajectory));
}

bool BestPlan::changed(double gain) {
  loss_ -= gain;
  if (loss_ > -kRounding) return false;
  loss_ = 0.0;
  differences_.clear();
  return true;
}

void BestPlan::restore() {
  for (auto& [robot, trajectory] : differences_) incumbent_.replace(robot, std::move(trajectory));
  differences_.clear();
  loss_ = 0.0;
}

}  // namespace fleetplan::core
