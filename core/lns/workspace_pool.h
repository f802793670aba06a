#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <vector>

#include "core/instance/instance.h"
#include "core/lns/incumbent.h"
#include "core/lns/neighbourhood.h"
#include "core/model/trajectory.h"
#include "core/prioritized/plan_state.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// What one thread needs to search on its own: a plan state with the incumbent's trajectories.
class Workspace {
 public:
  /// A workspace with the caller's state, which follows the incumbent already.
  Workspace(PlanState& state, const Incumbent& incumbent, const StopCondition& stop);
  /// A workspace with an instance like this one and a state of its own. Robots that are not in the incumbent
  /// stay at their starts.
  Workspace(const Instance& instance, const Incumbent& incumbent, const StopCondition& stop);

  PlanState& state() { return *state_; }
  bool has_own_state() const { return own_state_ != nullptr; }
  NeighbourhoodSelection& neighbourhoods() { return neighbourhoods_; }
  /// Adopts the trajectories that have been replaced in the incumbent since the last call.
  void update();
  /// Updates with other trajectories for some robots, until the next update.
  void update(const std::map<std::size_t, Trajectory>& others);
  /// To be called when the trajectories of the state may differ from those of the last update, or may be
  /// missing.
  void invalidate();

 private:
  std::unique_ptr<Instance> own_instance_;
  std::unique_ptr<PlanState> own_state_;
  PlanState* state_;
  const Incumbent& incumbent_;
  std::vector<std::int64_t> versions_;  // versions of the incumbent's trajectories, by robot
  NeighbourhoodSelection neighbourhoods_;
};

/// A pool of as many workspaces as threads use at the same time. Thread-safe, also while the incumbent
/// changes.
class WorkspacePool {
 public:
  /// The pool of a search. Its first workspace uses `state`, which follows the incumbent.
  WorkspacePool(PlanState& state, const Incumbent& incumbent, const StopCondition& stop);

  /// Returns a workspace for the exclusive use of the caller, to be updated; null if the job has no memory
  /// for it.
  std::unique_ptr<Workspace> take();
  void give_back(std::unique_ptr<Workspace> workspace);
  /// Updates the workspace with the caller's state, with other trajectories for some robots. All workspaces
  /// have been given back, and the incumbent does not change.
  void update_callers_state(const std::map<std::size_t, Trajectory>& others);
  /// Frees all workspaces but that with the caller's state; returns false if there was no other.
  bool release_others();

 private:
  std::unique_ptr<Workspace> take_idle();

  const Instance& instance_;
  const Incumbent& incumbent_;
  const StopCondition& stop_;
  std::mutex mutex_;
  std::vector<std::unique_ptr<Workspace>> idle_;
};

}  // namespace fleetplan::core
