#include "core/execution/simulation/execution_policy.h"

#include <utility>

namespace fleetplan::core {
namespace {

constexpr std::size_t kPolicyActionsBetweenPolls = 256;

}  // namespace

std::optional<ExecutedProgress> execute_alone(const PlannedExecution& planned, std::size_t plan,
                                              const DisturbedActions& disturbed, const StopCondition& stop) {
  const std::vector<Action>& actions = planned.plans[plan].actions;
  ProgressBuilder builder;
  StopStride stride = StopStride::from_first(stop, kPolicyActionsBetweenPolls);
  for (std::size_t k = 0; k < actions.size(); ++k) {
    if (stride.met_at_step()) return std::nullopt;
    const Action& action = actions[k];
    builder.begin_action(k);
    if (!goes_on_at_speed(actions, k)) builder.stand_for(disturbed.actions[k].start_delay);
    if (action.profile) {
      DisturbedDrive driven(actions, k, disturbed, builder.now(), action.profile->start);
      while (const auto halt = driven.next_halt()) {
        if (stop.met()) return std::nullopt;
        driven.drive.head_for(halt->place);
        builder.drive(driven.drive.drive_to(halt->place));
        builder.stand_for(halt->seconds);
        driven.pass_halt(builder.now());
      }
      driven.drive.head_for(driven.drive.length());
      builder.drive(driven.drive.drive_to(driven.drive.length()));
      builder.complete(driven.drive.end());
      k = driven.drive.end() - 1;
    } else if (action.type != Action::Type::wait) {
      const auto phases = moving_phases(disturbed, k, stop);
      if (!phases) return std::nullopt;
      for (const ActionPhase& phase : *phases) builder.go_on(phase.seconds, phase.to_fraction);
    } else if (planned.policy == ExecutionPolicy::open_loop) {
      builder.go_on(action.t_end - action.t_start, 1.0);
    } else {
      const double least = planned.purposes[plan][k].least;
      builder.stand_until(action.t_end - least);
      builder.go_on(least, 1.0);
    }
  }
  return std::move(builder.progress());
}

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
