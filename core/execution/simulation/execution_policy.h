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
  /// Every action lasts its planned time, plus disturbances. No robot looks at a clock or at others.
  open_loop,
  /// A wait ends at its planned time, or at once if that has passed (paper, "Increasing robustness").
  absorb_waits,
  /// Robots obey the dependencies, and skip waits that only give way.
  dependencies,
  /// All robots follow one clock. It slows down so that no robot is later than the largest delay.
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

/// Executes one plan under a policy in which robots do not communicate: `open_loop` or `absorb_waits`. For a
/// robot with profiles, the factors of the disturbance apply to its cruise speeds, and it brakes for halts.
/// Returns none if `stop` is met first.
std::optional<ExecutedProgress> execute_alone(const PlannedExecution& planned, std::size_t plan,
                                              const DisturbedActions& disturbed, const StopCondition& stop);

/// Executes all plans under the policy `dependencies`. Robots that wait for each other for ever do not
/// arrive. Returns none if `stop` is met first.
std::optional<std::vector<ExecutedProgress>> execute_dependencies(
    const PlannedExecution& planned, const std::vector<DisturbedActions>& disturbed,
    const StopCondition& stop);

/// Executes all plans under the policy `clock_stop`, with a clock that all robots share. No action begins
/// before its planned time, and no robot moves faster than planned.
///
/// When a robot is as late as allowed and slower than planned, the clock and all other robots slow down to
/// its pace. They stand while it stands. This is the limit of robots that stop whenever a robot is later, if
/// they notice it at once. With a profile, a robot is where the profile is at its own time. It also changes
/// its pace at once.
///
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
