#include "core/execution/simulation/execution_policy.h"

#include <utility>

namespace fleetplan::core {

std::optional<std::vector<ExecutedProgress>> execute_plans(const PlannedExecution& planned,
                                                           const std::vector<DisturbedActions>& disturbed,
                                                           const StopCondition& stop) {
  switch (planned.policy) {
    case ExecutionPolicy::dependencies:
      return execute_dependencies(planned, disturbed, stop);
    case ExecutionPolicy::clock_stop:
      return execute_with_clock(planned, disturbed, stop);
    case ExecutionPolicy::open_loop:
    case ExecutionPolicy::absorb_waits:
      break;
  }
  std::vector<ExecutedProgress> executed;
  executed.reserve(disturbed.size());
  for (std::size_t plan = 0; plan < disturbed.size(); ++plan) {
    auto progress = execute_alone(planned, plan, disturbed[plan], stop);
    if (!progress) return std::nullopt;
    executed.push_back(std::move(*progress));
  }
  return executed;
}

}  // namespace fleetplan::core
