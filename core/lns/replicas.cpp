#include "core/lns/replicas.h"

#include <algorithm>
#include <utility>

namespace fleetplan::core {

Incumbent::Incumbent(const PlanState& state, std::vector<std::size_t> planned)
    : planned_(std::move(planned)),
      trajectories_(state.instance().size()),
      versions_(state.instance().size(), 0) {
  for (const std::size_t robot : planned_) trajectories_[robot] = *state.trajectory(robot);
}

void Incumbent::replace(std::size_t robot, Trajectory trajectory) {
  trajectories_[robot] = std::move(trajectory);
  ++versions_[robot];
}

Replica::Replica(PlanState& state, const Incumbent& incumbent, const StopCondition& stop)
    : state_(&state),
      incumbent_(incumbent),
      versions_(state.instance().size(), 0),
      neighbourhoods_(state, incumbent.planned(), stop) {}

Replica::Replica(const Problem& problem, const PlanOptions& options, const Incumbent& incumbent,
                 const StopCondition& stop)
    : own_fleet_(std::make_unique<Instance>(problem, options)),
      own_state_(std::make_unique<PlanState>(*own_fleet_)),
      state_(own_state_.get()),
      incumbent_(incumbent),
      versions_(own_fleet_->size(), -1),
      neighbourhoods_(*state_, incumbent.planned(), stop) {
  std::vector<bool> stands(own_fleet_->size(), true);
  for (const std::size_t robot : incumbent.planned()) stands[robot] = false;
  for (std::size_t robot = 0; robot < stands.size(); ++robot) {
    if (stands[robot]) state_->stay_at_start(robot);
  }
}

void Replica::catch_up() {
  std::vector<std::size_t> behind;
  for (const std::size_t robot : incumbent_.planned()) {
    if (versions_[robot] != incumbent_.version(robot)) behind.push_back(robot);
  }
  for (const std::size_t robot : behind) state_->remove(robot);
  for (const std::size_t robot : behind) {
    state_->follow(robot, incumbent_.trajectory(robot));
    versions_[robot] = incumbent_.version(robot);
  }
}

Replicas::Replicas(PlanState& state, const Incumbent& incumbent, const StopCondition& stop)
    : problem_(state.instance().problem()),
      options_(state.instance().options()),
      incumbent_(incumbent),
      stop_(stop) {
  idle_.push_back(std::make_unique<Replica>(state, incumbent, stop));
}

std::unique_ptr<Replica> Replicas::take() {
  std::unique_ptr<Replica> replica;
  {
    const std::scoped_lock lock(mutex_);
    if (!idle_.empty()) {
      replica = std::move(idle_.back());
      idle_.pop_back();
    }
  }
  if (!replica) replica = std::make_unique<Replica>(problem_, options_, incumbent_, stop_);
  replica->catch_up();
  return replica;
}

void Replicas::give_back(std::unique_ptr<Replica> replica) {
  const std::scoped_lock lock(mutex_);
  idle_.push_back(std::move(replica));
}

void Replicas::catch_up() {
  for (const auto& replica : idle_) replica->catch_up();
}

}  // namespace fleetplan::core
