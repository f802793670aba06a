#pragma once

// How robots execute their plans when they are disturbed.

#include <cstddef>
#include <optional>
#include <vector>

#include "core/execution/dependency.h"
#include "core/execution/executed_actions.h"
#include "core/execution/simulation/disturbance.h"
#include "core/execution/simulation/executed_motion.h"
#include "core/model/plan.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

enum class ExecutionPolicy {
  /// Every action lasts its planned time, disturbed. Nobody looks at a clock or at others.
  open_loop,
  /// A wait ends at its planned time, or at once if that has passed (paper, "Increasing robustness").
  absorb_waits,
  /// Robots obey the dependencies, and skip waits that only give way.
  dependencies,
  /// All follow one clock, which slows down so that nobody is later by it than the largest delay.
  clock_stop,
};

/// Plans to execute. Their actions are contiguous in time and space from t = 0 on.
struct PlannedExecution {
  const std::vector<RobotPlan>& plans;
  std::vector<std::vector<WaitPurpose>> purposes;  // by plan, see wait_purposes
  ExecutionPolicy policy = ExecutionPolicy::open_loop;
  std::vector<Dependency> dependencies = {};  // of that policy; their robots are positions in `plans`
  double max_delay = 0.0;                     // of clock_stop: seconds, >= 0
};

/// Policies without a word between robots. Returns none if `stop` is met first.
std::optional<ExecutedProgress> execute_alone(const PlannedExecution& planned, std::size_t plan,
                                              const DisturbedActions& disturbed, const StopCondition& stop);

/// The policy `dependencies`. Robots that wait for each other for ever do not arrive. Returns none if `stop`
/// is met first.
std::optional<std::vector<ExecutedProgress>> execute_dependencies(
    const PlannedExecution& planned, const std::vector<DisturbedActions>& disturbed,
    const StopCondition& stop);

/// The policy `clock_stop`. Robots follow the plan by a clock that all of them share: no action begins before
/// its planned time, and nobody moves faster than planned. While a robot is as late as is allowed and slower
/// than planned, the clock, and with it everybody else, goes as slowly as that robot; it stands while that
/// robot stands. This is what standing still whenever somebody is later comes to, if that is noticed at once.
/// Returns none if `stop` is met first.
std::optional<std::vector<ExecutedProgress>> execute_with_clock(
    const PlannedExecution& planned, const std::vector<DisturbedActions>& disturbed,
    const StopCondition& stop);

/// By the policy of the plans; in their order.
std::optional<std::vector<ExecutedProgress>> execute_plans(const PlannedExecution& planned,
                                                           const std::vector<DisturbedActions>& disturbed,
                                                           const StopCondition& stop);

}  // namespace fleetplan::core
