#include "core/lns/workspace_pool.h"

#include <utility>

namespace fleetplan::core {

Workspace::Workspace(PlanState& state, const Incumbent& incumbent, const StopCondition& stop)
    : state_(&state),
      incumbent_(incumbent),
      versions_(state.instance().size(), 0),
      neighbourhoods_(state, incumbent.planned(), stop) {}

Workspace::Workspace(const Problem& problem, const PlanOptions& options, const Incumbent& incumbent,
                     const StopCondition& stop)
    : own_instance_(std::make_unique<Instance>(problem, options)),
      own_state_(std::make_unique<PlanState>(*own_instance_)),
      state_(own_state_.get()),
      incumbent_(incumbent),
      versions_(own_instance_->size(), -1),
      neighbourhoods_(*state_, incumbent.planned(), stop) {
  std::vector<bool> stays(own_instance_->size(), true);
  for (const std::size_t robot : incumbent.planned()) stays[robot] = false;
  for (std::size_t robot = 0; robot < stays.size(); ++robot) {
    if (stays[robot]) state_->stay_at_start(robot);
  }
}

void Workspace::update() {
  std::vector<std::size_t> outdated;
  for (const std::size_t robot : incumbent_.planned()) {
    if (versions_[robot] != incumbent_.version(robot)) outdated.push_back(robot);
  }
  for (const std::size_t robot : outdated) state_->remove(robot);
  for (const std::size_t robot : outdated) {
    state_->follow(robot, incumbent_.trajectory(robot));
    versions_[robot] = incumbent_.version(robot);
  }
}

WorkspacePool::WorkspacePool(PlanState& state, const Incumbent& incumbent, const StopCondition& stop)
    : problem_(state.instance().problem()),
      options_(state.instance().options()),
      incumbent_(incumbent),
      stop_(stop) {
  idle_.push_back(std::make_unique<Workspace>(state, incumbent, stop));
}

std::unique_ptr<Workspace> WorkspacePool::take() {
  std::unique_ptr<Workspace> workspace;
  {
    const std::scoped_lock lock(mutex_);
    if (!idle_.empty()) {
      workspace = std::move(idle_.back());
      idle_.pop_back();
    }
  }
  if (!workspace) workspace = std::make_unique<Workspace>(problem_, options_, incumbent_, stop_);
  workspace->update();
  return workspace;
}

void WorkspacePool::give_back(std::unique_ptr<Workspace> workspace) {
  const std::scoped_lock lock(mutex_);
  idle_.push_back(std::move(workspace));
}

void WorkspacePool::update_all() {
  for (const auto& workspace : idle_) workspace->update();
}

}  // namespace fleetplan::core
