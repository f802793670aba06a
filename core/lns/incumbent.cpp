#include "core/lns/incumbent.h"

#include <algorithm>
#include <new>
#include <utility>

#include "core/model/objective_share.h"
#include "core/runtime/memory_account.h"

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
  return core::share_of(instance_.itinerary(robot), instance_.options().objective, trajectories_[robot]);
}

double Incumbent::least_share(std::size_t robot, double cost) const {
  return core::least_share(instance_.itinerary(robot), instance_.options().objective, cost);
}

double Incumbent::cost_with_share(std::size_t robot, double share) const {
  return core::cost_with_share(instance_.itinerary(robot), instance_.options().objective, share);
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

Workspace::Workspace(PlanState& state, const Incumbent& incumbent, const StopCondition& stop)
    : state_(&state),
      incumbent_(incumbent),
      versions_(state.instance().size(), 0),
      neighbourhoods_(state, incumbent.planned(), stop) {}

Workspace::Workspace(const Instance& instance, const PlanOptions& options, const Incumbent& incumbent,
                     const StopCondition& stop)
    : own_instance_(std::make_unique<Instance>(instance.problem(), options, instance.fixed_reservations(),
                                               stop.despite_memory())),
      own_state_(std::make_unique<PlanState>(*own_instance_)),
      state_(own_state_.get()),
      incumbent_(incumbent),
      versions_(own_instance_->size(), -1),
      neighbourhoods_(*state_, incumbent.planned(), stop) {
  std::vector<bool> stays(own_instance_->size(), true);
  for (const std::size_t robot : incumbent.followers()) stays[robot] = false;
  for (std::size_t robot = 0; robot < stays.size(); ++robot) {
    if (stays[robot]) state_->reservations().stay_in_place(robot);
  }
}

bool Workspace::follow_incumbent(const StopCondition& stop) {
  constexpr std::size_t kRobotsBetweenPolls = 8;
  StopStride stride(stop, kRobotsBetweenPolls);
  for (const std::size_t robot : incumbent_.followers()) {
    if (stride.met_at_step()) return false;
    state_->reservations().follow(robot, incumbent_.trajectory(robot));
    versions_[robot] = incumbent_.version(robot);
  }
  return true;
}

void Workspace::update() {
  std::vector<std::size_t> outdated;
  for (const std::size_t robot : incumbent_.followers()) {
    if (versions_[robot] != incumbent_.version(robot)) outdated.push_back(robot);
  }
  for (const std::size_t robot : outdated) state_->reservations().remove(robot);
  for (const std::size_t robot : outdated) {
    state_->reservations().follow(robot, incumbent_.trajectory(robot));
    versions_[robot] = incumbent_.version(robot);
  }
}

void Workspace::update(const std::map<std::size_t, Trajectory>& others) {
  update();
  for (const auto& [robot, trajectory] : others) {
    state_->reservations().remove(robot);
    versions_[robot] = -1;
  }
  for (const auto& [robot, trajectory] : others) state_->reservations().follow(robot, trajectory);
}

void Workspace::invalidate() { std::fill(versions_.begin(), versions_.end(), -1); }

WorkspacePool::WorkspacePool(PlanState& state, const Incumbent& incumbent, const StopCondition& stop)
    : instance_(state.instance()), options_(instance_.options()), incumbent_(incumbent), stop_(stop) {
  idle_.push_back(std::make_unique<Workspace>(state, incumbent, stop));
}

/// With a horizon, costs contain estimates that depend on the moves. So costs before and after could not be
/// compared.
bool WorkspacePool::may_add_moves() const {
  constexpr int kMaxNeighbours = 32;
  if (!options_.any_angle || options_.horizon || options_.connectivity == kMaxNeighbours) return false;
  // Bounded: the goals of a request, once.
  for (std::size_t robot = 0; robot < instance_.size(); ++robot) {
    const std::size_t goals = instance_.itinerary(robot).goals.size();
    for (std::size_t stage = 0; stage <= (instance_.views(robot).change() ? goals : 0); ++stage) {
      if (instance_.views(robot)[stage].free_space->finer().count() > 0) return false;
    }
  }
  return true;
}

bool WorkspacePool::add_moves() {
  if (!may_add_moves()) return false;
  std::erase_if(idle_, [](const auto& workspace) { return workspace->has_own_state(); });
  PlanOptions options = options_;
  options.connectivity *= 2;
  std::unique_ptr<Workspace> first;
  try {
    first = std::make_unique<Workspace>(instance_, options, incumbent_, stop_);
    if (!first->follow_incumbent(stop_) || is_short_of_memory()) return false;
  } catch (const std::bad_alloc&) {  // not granted to the job
    return false;
  }
  options_ = options;
  if (!idle_.empty()) callers_ = std::move(idle_.front());
  idle_.clear();
  idle_.push_back(std::move(first));
  return true;
}

std::unique_ptr<Workspace> WorkspacePool::take() {
  std::unique_ptr<Workspace> workspace = take_idle();
  try {
    if (!workspace) workspace = std::make_unique<Workspace>(instance_, options_, incumbent_, stop_);
  } catch (const std::bad_alloc&) {  // not granted to the job
    return nullptr;
  }
  return workspace;
}

std::unique_ptr<Workspace> WorkspacePool::take_idle() {
  const std::scoped_lock lock(mutex_);
  if (idle_.empty()) return nullptr;
  std::unique_ptr<Workspace> workspace = std::move(idle_.back());
  idle_.pop_back();
  return workspace;
}

void WorkspacePool::give_back(std::unique_ptr<Workspace> workspace) {
  const std::scoped_lock lock(mutex_);
  idle_.push_back(std::move(workspace));
}

void WorkspacePool::update_callers_state(const std::map<std::size_t, Trajectory>& others) {
  if (callers_) callers_->update(others);
  for (const auto& workspace : idle_) {
    if (!workspace->has_own_state()) workspace->update(others);
  }
}

bool WorkspacePool::release_others() {
  const auto released =
      std::erase_if(idle_, [](const auto& workspace) { return workspace->has_own_state(); });
  if (!callers_) return released > 0;
  idle_.push_back(std::move(callers_));
  return true;
}

}  // namespace fleetplan::core
