#include "core/execution/simulation/execution_policy.h"

#include <algorithm>
#include <utility>

namespace fleetplan::core {
namespace {

constexpr std::size_t kPolicyActionsBetweenPolls = 256;

}  // namespace

std::optional<ExecutedProgress> execute_alone(const PlannedExecution& planned, std::size_t plan,
                                              const DisturbedActions& disturbed, const StopCondition& stop) {
  const std::vector<Action>& actions = planned.plans[plan].actions;
  ProgressBuilder builder;
  for (std::size_t k = 0; k < actions.size(); ++k) {
    if (k % kPolicyActionsBetweenPolls == 0 && stop.met()) return std::nullopt;
    const Action& action = actions[k];
    builder.begin_action(k);
    builder.stand_for(disturbed.actions[k].start_delay);
    if (action.type != Action::Type::wait) {
      const auto phases = moving_phases(disturbed, k, stop);
      if (!phases) return std::nullopt;
      for (const Phase& phase : *phases) builder.go_on(phase.seconds, phase.to_fraction);
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

namespace {

constexpr std::size_t kStepsBetweenPolls = 256;

/// Lets a robot pass `place` once another robot has reached its own place.
struct Gate {
  ActionPlace place;
  std::size_t other = 0;
  ActionPlace until;
};

/// Returns the place of a progress that is to be reached: after an action rather than before the next one.
ActionPlace as_reached(const ActionProgress& progress) {
  if (progress.fraction > 0.0 || progress.action == 0) return {progress.action, progress.fraction};
  return {progress.action - 1, 1.0};
}

/// Returns when the robot reaches the place, seconds; none if it has not come so far.
std::optional<double> time_reached(const ExecutedProgress& progress, const ActionPlace& place) {
  if (place.action == 0 && place.fraction <= 0.0) return 0.0;
  const auto found = std::lower_bound(progress.knots.begin(), progress.knots.end(), place,
                                      [](const ExecutionKnot& knot, const ActionPlace& sought) {
                                        return ActionPlace{knot.action, knot.fraction} < sought;
                                      });
  if (found == progress.knots.end()) return std::nullopt;
  if (found->action != place.action || found == progress.knots.begin()) return found->t;
  const ExecutionKnot& before = *(found - 1);
  if (before.action != place.action) return found->t;
  const double part = (place.fraction - before.fraction) / (found->fraction - before.fraction);
  return before.t + part * (found->t - before.t);
}

/// Lets every robot go on as far as it is known to be allowed, until nobody can.
class DependentExecution {
 public:
  DependentExecution(const PlannedExecution& planned, const std::vector<DisturbedActions>& disturbed,
                     const StopCondition& stop)
      : planned_(planned), disturbed_(disturbed), stop_(stop), robots_(planned.plans.size()) {
    for (const Dependency& dependency : planned.dependencies) {
      const ActionPlace place = place_of(dependency.gate);
      robots_[dependency.gate.robot].gates.push_back(
          {place, dependency.until.robot, as_reached(dependency.until)});
    }
    for (Robot& robot : robots_) {
      std::stable_sort(robot.gates.begin(), robot.gates.end(),
                       [](const Gate& a, const Gate& b) { return a.place < b.place; });
    }
  }

  std::optional<std::vector<ExecutedProgress>> run() {
    std::vector<std::size_t> ready(robots_.size());
    for (std::size_t k = 0; k < ready.size(); ++k) ready[k] = k;
    while (!ready.empty()) {
      if (stop_.met()) return std::nullopt;
      const std::size_t robot = ready.back();
      ready.pop_back();
      if (!advance(robot)) robots_[robots_[robot].blocked_by].waiting.push_back(robot);
      if (stopped_) return std::nullopt;
      // Robots that wait for this one again after another look are registered again.
      const std::vector<std::size_t> waiting = std::exchange(robots_[robot].waiting, {});
      if (stops_after(waiting.size())) return std::nullopt;
      for (const std::size_t other : waiting) {
        const Robot& waits = robots_[other];
        const bool may_go =
            time_reached(robots_[robot].builder.progress(), waits.gates[waits.gate].until).has_value();
        (may_go ? ready : robots_[robot].waiting).push_back(other);
      }
    }
    std::vector<ExecutedProgress> executed;
    executed.reserve(robots_.size());
    for (std::size_t robot = 0; robot < robots_.size(); ++robot) {
      ExecutedProgress& progress = robots_[robot].builder.progress();
      progress.arrived = robots_[robot].action == planned_.plans[robot].actions.size();
      executed.push_back(std::move(progress));
    }
    return executed;
  }

 private:
  struct Robot {
    std::vector<Gate> gates = {};
    std::size_t gate = 0;    // index of the next one
    std::size_t action = 0;  // index of the present or next one
    bool begun = false;      // the action has begun
    std::vector<Phase> phases = {};
    std::size_t phase = 0;
    ProgressBuilder builder = {};
    std::size_t blocked_by = 0;
    std::vector<std::size_t> waiting = {};  // robots that wait for this one
  };

  /// Counts steps and looks at the stop condition once in many of them. Returns whether it was met.
  bool stops_after(std::size_t steps) {
    steps_ += steps;
    if (steps_ < kStepsBetweenPolls) return stopped_;
    steps_ = 0;
    return stopped_ = stopped_ || stop_.met();
  }

  /// Executes a robot until the end of its plan and returns true; or until a gate that is not known to open,
  /// or until the stop condition is met, and returns false.
  bool advance(std::size_t index) {
    Robot& robot = robots_[index];
    const std::size_t actions = planned_.plans[index].actions.size();
    while (robot.action < actions) {
      if (stops_after(1)) return false;
      if (!robot.begun) {
        robot.builder.begin_action(robot.action);
        robot.begun = true;
      }
      if (robot.phases.empty()) {
        if (!pass_gates(robot, 0.0)) return false;
        if (!prepare(index, robot)) return false;
      }
      for (; robot.phase < robot.phases.size(); ++robot.phase) {
        if (stops_after(1) || !advance_phase(robot)) return false;
      }
      robot.phases.clear();
      robot.begun = false;
      ++robot.action;
    }
    return true;
  }

  /// Prepares the phases of an action that may begin. Returns false if the stop condition is met.
  bool prepare(std::size_t index, Robot& robot) {
    const DisturbedActions& disturbed = disturbed_[index];
    robot.builder.stand_for(disturbed.actions[robot.action].start_delay);
    robot.phase = 0;
    if (planned_.plans[index].actions[robot.action].type != Action::Type::wait) {
      auto phases = moving_phases(disturbed, robot.action, stop_);
      stopped_ = stopped_ || !phases;
      if (phases) robot.phases = std::move(*phases);
      return !stopped_;
    }
    const WaitPurpose& purpose = planned_.purposes[index][robot.action];
    robot.builder.stand_until(purpose.not_before);
    robot.phases = {{purpose.least, 1.0}};
    return true;
  }

  /// Executes the present phase. Returns false at a gate that is not known to open; what remains of the phase
  /// is kept.
  bool advance_phase(Robot& robot) {
    Phase& phase = robot.phases[robot.phase];
    while (robot.gate < robot.gates.size()) {
      if (stops_after(1)) return false;
      const ActionPlace& place = robot.gates[robot.gate].place;
      if (place.action != robot.action || place.fraction >= phase.to_fraction) break;
      const double from = robot.builder.fraction();
      if (place.fraction > from) {
        const double part = (place.fraction - from) / (phase.to_fraction - from);
        robot.builder.go_on(part * phase.seconds, place.fraction);
        phase.seconds *= 1.0 - part;
      }
      if (!pass_gates(robot, place.fraction)) return false;
    }
    robot.builder.go_on(phase.seconds, phase.to_fraction);
    return true;
  }

  /// Waits at the gates up to a fraction of the present action. Returns false if one of them is not known to
  /// open.
  bool pass_gates(Robot& robot, double fraction) {
    const ActionPlace here{robot.action, fraction};
    for (; robot.gate < robot.gates.size() && !(here < robot.gates[robot.gate].place); ++robot.gate) {
      if (stops_after(1)) return false;
      const Gate& gate = robot.gates[robot.gate];
      const auto opens = time_reached(robots_[gate.other].builder.progress(), gate.until);
      if (!opens) {
        robot.blocked_by = gate.other;
        return false;
      }
      robot.builder.stand_until(*opens);
    }
    return true;
  }

  const PlannedExecution& planned_;
  const std::vector<DisturbedActions>& disturbed_;
  const StopCondition& stop_;
  std::size_t steps_ = 0;  // steps since the last look at the stop condition
  bool stopped_ = false;
  std::vector<Robot> robots_;
};

}  // namespace

std::optional<std::vector<ExecutedProgress>> execute_dependencies(
    const PlannedExecution& planned, const std::vector<DisturbedActions>& disturbed,
    const StopCondition& stop) {
  return DependentExecution(planned, disturbed, stop).run();
}

}  // namespace fleetplan::core
