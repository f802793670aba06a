#pragma once

// What lets iterations of large neighbourhood search overlap: steps that run at the same time and end in
// order, and a plan state for each thread.

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "core/instance/instance.h"
#include "core/lns/incumbent.h"
#include "core/lns/neighbourhood.h"
#include "core/model/plan_options.h"
#include "core/model/trajectory.h"
#include "core/prioritized/plan_state.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// Steps that run at the same time on several threads and yet depend on their order alone. Step k begins with
/// what the steps up to k - lag have brought, on any number of threads. So a thread waits only if step
/// k - lag still runs.
template <class Step>
class Pipeline {
 public:
  /// A step that runs, or none. It ends with this object.
  class Running;

  explicit Pipeline(std::size_t lag) : lag_(lag) {}

  /// Begins the next step, on the thread that will run it. Waits until the step `lag` before it has ended,
  /// and completes that one. `complete(step)` and `next()` are called in the order of the steps, one at a
  /// time. `next()` returns the step, or nothing if there is none. What they throw is passed on: a step that
  /// could not be completed remains, and one that could not be made does not begin.
  template <class Complete, class Next>
  Running begin(const Complete& complete, const Next& next) {
    std::unique_lock lock(mutex_);
    ended_.wait(lock, [&] { return entries_.size() < lag_ || entries_.front().has_ended; });
    if (entries_.size() == lag_) complete_first(complete);
    std::optional<Step> step = next();
    if (!step) return {};
    entries_.push_back({std::move(*step)});
    return {*this, entries_.back()};
  }

  /// Completes the steps that are left; all of them have ended.
  template <class Complete>
  void complete_all(const Complete& complete) {
    while (!entries_.empty()) complete_first(complete);
  }

 private:
  struct Entry {
    Step step;
    bool has_ended = false;
  };

  template <class Complete>
  void complete_first(const Complete& complete) {
    complete(entries_.front().step);
    entries_.pop_front();
  }

  void end(Entry& entry) {
    {
      const std::scoped_lock lock(mutex_);
      entry.has_ended = true;
    }
    ended_.notify_all();
  }

  const std::size_t lag_;
  std::mutex mutex_;
  std::condition_variable ended_;
  std::deque<Entry> entries_;  // steps that have begun and are not completed; their addresses last
};

template <class Step>
class Pipeline<Step>::Running {
 public:
  Running() = default;
  Running(Pipeline& pipeline, Entry& entry) : pipeline_(&pipeline), entry_(&entry) {}
  ~Running() {
    if (entry_ != nullptr) pipeline_->end(*entry_);
  }
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;

  explicit operator bool() const { return entry_ != nullptr; }
  Step& operator*() const { return entry_->step; }

 private:
  Pipeline* pipeline_ = nullptr;
  Entry* entry_ = nullptr;
};

/// What one thread needs to search on its own: a plan state with the incumbent's trajectories.
class Workspace {
 public:
  /// A workspace with the caller's state, which follows the incumbent already.
  Workspace(PlanState& state, const Incumbent& incumbent, const StopCondition& stop);
  /// A workspace with an instance like this one, but for these options, and a state of its own. Robots that
  /// are not in the incumbent stay at their starts.
  Workspace(const Instance& instance, const PlanOptions& options, const Incumbent& incumbent,
            const StopCondition& stop);

  PlanState& state() { return *state_; }
  bool has_own_state() const { return own_state_ != nullptr; }
  NeighbourhoodSelection& neighbourhoods() { return neighbourhoods_; }
  /// Adopts all trajectories for the first time; false if `stop` is met first, and then it must not be used.
  bool follow_incumbent(const StopCondition& stop);
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
  /// From now on, vertices have twice as many neighbours: searches take longer, and find better ways around
  /// others. Returns false, and nothing changes, without any-angle moves, with a horizon, where the lattice
  /// is refined, which would take time again, and if time or memory do not suffice. All workspaces have been
  /// given back; that with the caller's state leaves the pool.
  bool add_moves();
  /// Updates the workspace with the caller's state, with other trajectories for some robots. All workspaces
  /// have been given back, and the incumbent does not change.
  void update_callers_state(const std::map<std::size_t, Trajectory>& others);
  /// Frees all workspaces but that with the caller's state, which is in the pool from now on. Returns false
  /// if nothing changes.
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
