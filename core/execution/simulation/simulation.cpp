#include "core/execution/simulation/simulation.h"

#include <algorithm>
#include <map>

#include "core/runtime/memory_account.h"
#include "core/verify/tolerances.h"

namespace fleetplan::core {
namespace {

/// Runs of one task: the work of handing out tasks vanishes beside it.
constexpr std::size_t kRunsOfATask = 4;
/// Tasks of one round, between which progress is reported: enough for many workers.
constexpr std::size_t kTasksOfARound = 16;
/// Metres by which disks may overlap: the default tolerance of POST /v1/validate, which dependencies use up,
/// and as much for rounding.
constexpr double kTolerance = 2.0 * kMostTolerance;

/// Adds up the runs, in their order.
class Study {
 public:
  Study(const SimulatedFleet& fleet, std::size_t runs) : plans_(fleet.execution.plans) {
    report_.totals.runs = runs;
    report_.delays.resize(plans_.size());
  }

  const SimulationProgress& totals() const { return report_.totals; }

  void add(const Simulator::Run& run) {
    const std::size_t number = report_.totals.done++;
    if (run.collisions.first) {
      ++report_.totals.collided;
      if (report_.first_collisions.size() < SimulationReport::kMostListed) {
        report_.first_collisions.push_back({number, *run.collisions.first});
      }
    }
    for (const auto& pair : run.collisions.pairs) ++pairs_[pair];
    if (!run.stuck.empty()) {
      ++report_.totals.deadlocked;
      if (report_.deadlocks.size() < SimulationReport::kMostListed) {
        report_.deadlocks.push_back({number, run.stuck});
      }
    }
    add_times(run);
  }

  SimulationReport take() {
    for (const auto& [pair, runs] : pairs_) report_.pairs.push_back({pair.first, pair.second, runs});
    std::stable_sort(
        report_.pairs.begin(), report_.pairs.end(),
        [](const SimulationReport::Pair& a, const SimulationReport::Pair& b) { return a.runs > b.runs; });
    if (report_.pairs.size() > SimulationReport::kMostListed) {
      report_.pairs.resize(SimulationReport::kMostListed);
    }
    return std::move(report_);
  }

 private:
  void add_times(const Simulator::Run& run) {
    double flowtime = 0.0;
    double makespan = 0.0;
    auto stuck = run.stuck.begin();
    for (std::size_t plan = 0; plan < run.ends.size(); ++plan) {
      if (stuck != run.stuck.end() && *stuck == plan) {
        ++stuck;
        continue;
      }
      flowtime += run.ends[plan];
      makespan = std::max(makespan, run.ends[plan]);
      report_.delays[plan].push_back(run.ends[plan] - plans_[plan].cost);
    }
    if (!run.stuck.empty()) return;
    report_.flowtimes.push_back(flowtime);
    report_.makespans.push_back(makespan);
  }

  const std::vector<RobotPlan>& plans_;
  std::map<std::pair<std::size_t, std::size_t>, std::size_t> pairs_;
  SimulationReport report_;
};

}  // namespace

Simulator::Simulator(const SimulatedFleet& fleet, const SimulationSettings& settings)
    : fleet_(fleet), settings_(settings), field_(fleet.grid), resting_(fleet.robots.size()) {
  std::vector<const RobotPlan*> plans(fleet.robots.size(), nullptr);
  for (const RobotPlan& plan : fleet.execution.plans) plans[plan.robot] = &plan;
  for (std::size_t robot = 0; robot < plans.size(); ++robot) {
    const std::vector<Leg> legs = core::execute(fleet.robots[robot], plans[robot]);
    if (plans[robot] == nullptr) resting_[robot] = legs;
    const bool leaves_path = plans[robot] != nullptr && settings.disturbance.leaves_paths();
    // On the planned path, it meets a wall whenever the plan does.
    if (leaves_path || find_wall(field_, robot, legs, fleet.body_radii[robot], kTolerance)) {
      near_walls_.push_back(robot);
    }
  }
}

std::optional<Simulator::Executed> Simulator::execute(std::uint64_t number, const StopCondition& stop) const {
  const std::vector<RobotPlan>& plans = fleet_.execution.plans;
  auto disturbed = draw_disturbances(plans, settings_.disturbance, settings_.seed, number, stop);
  if (!disturbed) return std::nullopt;
  auto progress = execute_plans(fleet_.execution, *disturbed, stop);
  if (!progress) return std::nullopt;
  return Executed{std::move(*disturbed), std::move(*progress)};
}

std::optional<Simulator::Run> Simulator::run(std::uint64_t number, const StopCondition& stop) const {
  const std::vector<RobotPlan>& plans = fleet_.execution.plans;
  const auto executed = execute(number, stop);
  if (!executed) return std::nullopt;
  Run run;
  std::vector<std::vector<Leg>> legs = resting_;
  for (std::size_t plan = 0; plan < plans.size(); ++plan) {
    const ExecutedProgress& progress = executed->progress[plan];
    const std::size_t robot = plans[plan].robot;
    legs[robot] =
        executed_legs(fleet_.robots[robot], plans[plan].actions, executed->disturbed[plan], progress);
    run.ends.push_back(progress.end());
    if (!progress.arrived) run.stuck.push_back(plan);
  }
  auto collisions = find_collisions(legs, fleet_.body_radii, kTolerance, field_, near_walls_, stop);
  if (!collisions) return std::nullopt;
  run.collisions = std::move(*collisions);
  return run;
}

std::optional<Simulator::Trace> Simulator::trace(std::uint64_t number, const StopCondition& stop) const {
  const auto executed = execute(number, stop);
  if (!executed) return std::nullopt;
  Trace trace;
  const std::vector<RobotPlan>& plans = fleet_.execution.plans;
  for (std::size_t plan = 0; plan < plans.size(); ++plan) {
    trace.actions.push_back(
        disturbed_actions(plans[plan].actions, executed->disturbed[plan], executed->progress[plan]));
  }
  return trace;
}

SimulationReport simulate(const SimulatedFleet& fleet, const SimulationSettings& settings,
                          const StopCondition& stop, Executor& executor,
                          const std::function<bool(const SimulationProgress&)>& go_on) {
  const Simulator simulator(fleet, settings);
  Study study(fleet, settings.runs);
  MemoryAccount* account = MemoryScope::current();
  while (study.totals().done < settings.runs && !stop.met()) {
    if (go_on && !go_on(study.totals())) break;
    const std::size_t first = study.totals().done;
    const std::size_t count = std::min(settings.runs - first, kRunsOfATask * kTasksOfARound);
    std::vector<std::optional<Simulator::Run>> runs(count);
    executor.run((count + kRunsOfATask - 1) / kRunsOfATask, [&](std::size_t task) {
      const MemoryScope scope(account);
      const std::size_t end = std::min(count, (task + 1) * kRunsOfATask);
      for (std::size_t k = task * kRunsOfATask; k < end; ++k) runs[k] = simulator.run(first + k, stop);
    });
    for (const auto& run : runs) {
      if (!run) return study.take();
      study.add(*run);
    }
  }
  return study.take();
}

}  // namespace fleetplan::core
