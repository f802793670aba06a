#pragma once

#include <cstddef>
#include <cstdint>

#include "core/bounds/taut_path_bounds.h"
#include "core/lns/adaptive_parameters.h"
#include "core/lns/best_plan.h"
#include "core/lns/delayed_choice.h"
#include "core/lns/exhaustion.h"
#include "core/lns/incumbent.h"
#include "core/lns/replan.h"
#include "core/lns/workspace_pool.h"
#include "core/runtime/random.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// What an iteration of large neighbourhood search tries, and what came of it.
struct Iteration {
  std::int64_t version = 0;  // of the incumbent that it begins with
  AdaptiveParameters::Choice parameters;
  std::size_t first = 0;  // the robot that is to become cheaper
  ReplanOptions options;
  std::uint64_t seed = 0;
  ReplanResult result;
};

/// The steps of an iteration: choose, run, accept. While one runs, others may be chosen and accepted.
class Iterations {
 public:
  /// The arguments outlive this object. `for_makespan`: the objective.
  Iterations(Incumbent& incumbent, const Exhaustion& exhaustion, const TautPathBounds& bounds, Random& random,
             const StopCondition& stop, bool for_makespan)
      : incumbent_(incumbent),
        exhaustion_(exhaustion),
        bounds_(bounds),
        random_(random),
        stop_(stop),
        for_makespan_(for_makespan),
        best_(incumbent),
        first_robots_(incumbent.robot_count()) {}

  /// Chooses what to try next, by recent success.
  Iteration choose();
  /// Destroys and repairs, in a workspace with the incumbent at the time of choose(). On any thread.
  void run(Iteration& iteration, Workspace& workspace) const;
  /// Learns from the result and makes its change to the incumbent, unless changes made since choose() stand
  /// against it. Returns whether that is the best plan so far. The workspace may be updated.
  bool accept(Iteration& iteration, Workspace& workspace);

  BestPlan& best() { return best_; }

 private:
  double most_loss() const;
  std::size_t choose_delayed();
  void learn(const Iteration& iteration);
  bool is_outdated(const Iteration& iteration, Workspace& workspace) const;

  Incumbent& incumbent_;
  const Exhaustion& exhaustion_;
  const TautPathBounds& bounds_;
  Random& random_;
  const StopCondition& stop_;
  const bool for_makespan_;
  BestPlan best_;
  AdaptiveParameters parameters_;
  DelayedChoice first_robots_;
};

}  // namespace fleetplan::core
