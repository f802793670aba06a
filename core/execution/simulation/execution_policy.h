#pragma once

// How robots execute their plans when they are disturbed.

#include <cstddef>
#include <optional>
#include <vector>

#include "core/execution/dependencies.h"
#include "core/execution/executed_actions.h"
#include "core/execution/simulation/disturbance.h"
#include "core/execution/simulation/executed_motion.h"
#include "core/model/plan.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

enum class ExecutionPolicy {
  /// Every action lasts its planned time, disturbed. No robot looks at a clock or at others.
  open_loop,
  /// A wait ends at its planned time, or at once if that has passed (paper, "Increasing robustness").
  absorb_waits,
  /// Robots obey the dependencies, and skip waits that only give way.
  dependencies,
  /// All follow one clock, which slows down so that no robot is later by it than the largest delay.
  clock_stop,
};

/// Plans to execute. Their actions are contiguous in time and space from t = 0 on.
struct PlannedExecution {
  const std::vector<RobotPlan>& plans;
  std::vector<std::vector<WaitPurpose>> purposes;  // by plan, see wait_purposes
  ExecutionPolicy policy = ExecutionPolicy::open_loop;
  std::vector<Dependency> dependencies =
      {};                  // for the policy `dependencies`; their robots are positions in `plans`
  double max_delay = 0.0;  // for the policy `clock_stop`: seconds, >= 0
};

/// Executes one plan under a policy in which robots do not communicate: `open_loop` or `absorb_waits`. A
/// robot with profiles has the factors of the disturbance on its cruise speeds, and brakes for halts. Returns
/// none if `stop` is met first.
std::optional<ExecutedProgress> execute_alone(const PlannedExecution& planned, std::size_t plan,
                                              const DisturbedActions& disturbed, const StopCondition& stop);

/// Executes all plans under the policy `dependencies`. Robots that wait for each other for ever do not
/// arrive. Returns none if `stop` is met first.
std::optional<std::vector<ExecutedProgress>> execute_dependencies(
    const PlannedExecution& planned, const std::vector<DisturbedActions>& disturbed,
    const StopCondition& stop);

/// Executes all plans under the policy `clock_stop`: by a clock that all robots share, no action begins
/// before its planned time, and no robot moves faster than planned. While a robot is as late as is allowed
/// and slower than planned, the clock and all other robots go as slowly as that robot; they stand while it
/// stands. This is the limit of robots that stop whenever one of them is later, if that is noticed at once.
/// With a profile, a robot is where the profile is at its own time, and changes its pace at once, too.
/// Returns none if `stop` is met first.
std::optional<std::vector<ExecutedProgress>> execute_with_clock(
    const PlannedExecution& planned, const std::vector<DisturbedActions>& disturbed,
    const StopCondition& stop);

/// Executes all plans under their policy. The result is in the order of the plans. Returns none if `stop` is
/// met first.
std::optional<std::vector<ExecutedProgress>> execute_plans(const PlannedExecution& planned,
                                                           const std::vector<DisturbedActions>& disturbed,
                                                           const StopCondition& stop);

}  // namespace fleetplan::core
