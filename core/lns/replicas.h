#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include "core/instance.h"
#include "core/lns/neighbourhood.h"
#include "core/model/trajectory.h"
#include "core/prioritized/plan_state.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// The trajectories that everybody follows at the moment.
class Incumbent {
 public:
  /// Those of `planned` in `state`.
  Incumbent(const PlanState& state, std::vector<std::size_t> planned);

  const std::vector<std::size_t>& planned() const { return planned_; }
  const Trajectory& trajectory(std::size_t robot) const { return trajectories_[robot]; }
  double cost(std::size_t robot) const { return trajectories_[robot].cost; }
  /// How often the robot's trajectory has been replaced.
  std::int64_t version(std::size_t robot) const { return versions_[robot]; }
  void replace(std::size_t robot, Trajectory trajectory);

 private:
  std::vector<std::size_t> planned_;
  std::vector<Trajectory> trajectories_;  // by robot
  std::vector<std::int64_t> versions_;    // by robot
};

/// What one thread needs to search on its own: a state that follows the incumbent.
class Replica {
 public:
  /// Around a state that follows the incumbent already.
  Replica(PlanState& state, const Incumbent& incumbent, const StopCondition& stop);
  /// With a fleet and a state of its own. Robots that are not in the incumbent stand at their starts for
  /// ever.
  Replica(const Problem& problem, const PlanOptions& options, const Incumbent& incumbent,
          const StopCondition& stop);

  PlanState& state() { return *state_; }
  Neighbourhoods& neighbourhoods() { return neighbourhoods_; }
  /// Follows what has been replaced in the incumbent since.
  void catch_up();

 private:
  std::unique_ptr<Instance> own_fleet_;
  std::unique_ptr<PlanState> own_state_;
  PlanState* state_;
  const Incumbent& incumbent_;
  std::vector<std::int64_t> versions_;  // by robot
  Neighbourhoods neighbourhoods_;
};

/// As many replicas as there are threads at work. Thread-safe, as long as the incumbent stays the same.
class Replicas {
 public:
  /// The first one is around `state`, which follows the incumbent.
  Replicas(PlanState& state, const Incumbent& incumbent, const StopCondition& stop);

  /// A replica that nobody else has, up to date.
  std::unique_ptr<Replica> take();
  void give_back(std::unique_ptr<Replica> replica);
  /// Brings the state of the first one, and all others, up to date; all have been given back.
  void catch_up();

 private:
  const Problem& problem_;
  const PlanOptions options_;
  const Incumbent& incumbent_;
  const StopCondition& stop_;
  std::mutex mutex_;
  std::vector<std::unique_ptr<Replica>> idle_;
};

}  // namespace fleetplan::core
