#include "core/lns/incumbent.h"

#include <algorithm>
#include <utility>

#include "core/model/objective_share.h"

namespace fleetplan::core {

Incumbent::Incumbent(const PlanState& state, std::vector<std::size_t> planned)
    : instance_(state.instance()),
      planned_(std::move(planned)),
      trajectories_(state.instance().size()),
      shares_(state.instance().size(), 0.0),
      versions_(state.instance().size(), 0) {
  for (std::size_t robot = 0; robot < trajectories_.size(); ++robot) {
    if (!state.reservations().trajectory(robot)) continue;
    followers_.push_back(robot);
    trajectories_[robot] = *state.reservations().trajectory(robot);
    shares_[robot] = share_of(robot);
  }
}

double Incumbent::share_of(std::size_t robot) const {
  return core::share_of(instance_.robot(robot), instance_.options().objective, trajectories_[robot]);
}

double Incumbent::least_share(std::size_t robot, double cost) const {
  return core::least_share(instance_.robot(robot), instance_.options().objective, cost);
}

double Incumbent::cost_with_share(std::size_t robot, double share) const {
  return core::cost_with_share(instance_.robot(robot), instance_.options().objective, share);
}

std::size_t Incumbent::last_to_arrive() const {
  return *std::max_element(planned_.begin(), planned_.end(),
                           [&](std::size_t a, std::size_t b) { return cost(a) < cost(b); });
}

void Incumbent::replace(std::size_t robot, Trajectory trajectory) {
  trajectories_[robot] = std::move(trajectory);
  shares_[robot] = share_of(robot);
  versions_[robot] = ++version_;
}

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
