#pragma once

// The incumbent, which iterations begin with; the best plan; and the plan states that follow the incumbent,
// one for each thread.

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <vector>

#include "core/compile/instance.h"
#include "core/fleet/plan_state.h"
#include "core/lns/neighbourhood.h"
#include "core/lns/smoothing.h"
#include "core/model/plan_options.h"
#include "core/model/trajectory.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// The plan that iterations begin with: a trajectory for each planned robot. BestPlan has the best plan.
class Incumbent {
 public:
  /// Takes the trajectories in `state`, whose instance must outlive this object. Only the trajectories of the
  /// robots of `planned` may be replaced.
  Incumbent(const PlanState& state, std::vector<std::size_t> planned);

  /// Whether the paths of robots may be smoothed.
  bool may_smooth() const { return core::may_smooth(instance_.options()); }
  /// The number of robots, with and without a trajectory.
  std::size_t robot_count() const { return trajectories_.size(); }
  const std::vector<std::size_t>& planned() const { return planned_; }
  /// All robots with a trajectory, ascending.
  const std::vector<std::size_t>& followers() const { return followers_; }
  const Trajectory& trajectory(std::size_t robot) const { return trajectories_[robot]; }
  double cost(std::size_t robot) const { return trajectories_[robot].cost; }
  /// The robot's share in the objective, and a lower bound of the share of all trajectories that cost this
  /// much.
  double share(std::size_t robot) const { return shares_[robot]; }
  double least_share(std::size_t robot, double cost) const;
  /// The cost from which on no trajectory of the robot has a share below `share`, seconds.
  double cost_with_share(std::size_t robot, double share) const;
  /// The robot of the highest cost; there is at least one.
  std::size_t last_to_arrive() const;
  double makespan() const { return cost(last_to_arrive()); }
  /// Grows with each replacement, 0 at first.
  std::int64_t version() const { return version_; }
  /// The version of the plan that gave the robot its present trajectory.
  std::int64_t version(std::size_t robot) const { return versions_[robot]; }
  void replace(std::size_t robot, Trajectory trajectory);

 private:
  double share_of(std::size_t robot) const;

  const Instance& instance_;
  std::vector<std::size_t> planned_;
  std::vector<std::size_t> followers_;
  std::vector<Trajectory> trajectories_;  // by robot
  std::vector<double> shares_;            // by robot
  std::int64_t version_ = 0;
  std::vector<std::int64_t> versions_;  // by robot
};

/// The best plan of a search whose incumbent may become worse for a while. It stores only the trajectories in
/// which the two differ.
class BestPlan {
 public:
  /// The incumbent must outlive this object, and only this object changes it.
  explicit BestPlan(Incumbent& incumbent) : incumbent_(incumbent) {}

  void replace(std::size_t robot, Trajectory trajectory);
  /// Records a change; call it after its replacements. `gain`: by how much the objective fell, seconds;
  /// negative if it rose. Returns whether the incumbent is better than any plan before.
  bool changed(double gain);

  /// The trajectories of the best plan, by robot, where the incumbent may have others.
  const std::map<std::size_t, Trajectory>& differences() const { return differences_; }
  /// Makes the best plan the incumbent.
  void restore();

 private:
  Incumbent& incumbent_;
  std::map<std::size_t, Trajectory> differences_;
  double loss_ = 0.0;  // seconds by which the incumbent is worse than the best plan
};

/// What one thread needs to search on its own: a plan state with the incumbent's trajectories.
class Workspace {
 public:
  /// A workspace with the caller's state, which already follows the incumbent.
  Workspace(PlanState& state, const Incumbent& incumbent, const StopCondition& stop);
  /// A workspace with its own state, and with a copy of this instance under these options. Robots that are
  /// not in the incumbent stay at their starts.
  Workspace(const Instance& instance, const PlanOptions& options, const Incumbent& incumbent,
            const StopCondition& stop);

  PlanState& state() { return *state_; }
  bool has_own_state() const { return own_state_ != nullptr; }
  NeighbourhoodSelection& neighbourhoods() { return neighbourhoods_; }
  /// Adopts all trajectories for the first time. Returns false if `stop` is met first; then the workspace
  /// must not be used.
  bool follow_incumbent(const StopCondition& stop);
  /// Adopts the trajectories that have been replaced in the incumbent since the last call.
  void update();
  /// As update(), with other trajectories for some robots, until the next update.
  void update(const std::map<std::size_t, Trajectory>& others);
  /// Must be called when the trajectories of the state may be missing, or may have changed since the last
  /// update.
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
  /// From now on, vertices have twice as many neighbours. Searches take longer, and find better ways around
  /// other robots. All workspaces must have been given back; the workspace with the caller's state leaves the
  /// pool.
  ///
  /// Returns false, and changes nothing, in these cases:
  ///
  /// - Vertices have 32 neighbours already.
  /// - There are no any-angle moves, or there is a horizon.
  /// - The lattice is refined, because refining it again would take time.
  /// - Time or memory do not suffice.
  bool add_moves();
  /// Updates the workspace with the caller's state, with other trajectories for some robots. All workspaces
  /// must have been given back, and the incumbent must not change meanwhile.
  void update_callers_state(const std::map<std::size_t, Trajectory>& others);
  /// Frees all workspaces except the one with the caller's state, which is in the pool from now on. Returns
  /// false if nothing changes.
  bool release_others();

 private:
  bool may_add_moves() const;
  std::unique_ptr<Workspace> take_idle();

  const Instance& instance_;
  PlanOptions options_;
  const Incumbent& incumbent_;
  const StopCondition& stop_;
  std::mutex mutex_;
  std::vector<std::unique_ptr<Workspace>> idle_;
  std::unique_ptr<Workspace> callers_;  // with the caller's state, while it is not in the pool
};

}  // namespace fleetplan::core
