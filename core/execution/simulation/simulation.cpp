#include "core/execution/simulation/simulation.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "core/geometry/segment.h"
#include "core/runtime/memory_account.h"
#include "core/verify/check_rules.h"
#include "core/verify/geometry/relative_motion.h"
#include "core/verify/pairs/fleet_clearance.h"

namespace fleetplan::core {
namespace {

/// The most overlaps of one execution that are told apart: many robots in one place have millions of them.
constexpr std::size_t kMaxOverlaps = 10'000;

/// Legs between two checks of the stop condition; each takes time in proportion to the blocked cells near it.
constexpr std::size_t kLegsBetweenPolls = 8;

bool is_earlier(const ExecutedCollision& a, const ExecutedCollision& b) {
  return a.t != b.t ? a.t < b.t : a.first < b.first;
}

/// Returns the share of its time after which a leg has covered a share of its length.
double elapsed_at(const Leg& leg, double covered) {
  if (leg.bend == Position(0.0, 0.0)) return covered;
  const Position way = leg.to - leg.from;
  return elapsed_share(covered, leg.bend.dot(way) / way.squaredNorm());
}

Position position_of(const std::vector<Leg>& legs, double t) {
  return position_at(*first_leg_until(legs, t), t);
}

}  // namespace

void add_commitments(const std::vector<Robot>& robots, std::vector<RobotPlan>& plans) {
  std::vector<bool> has_plan(robots.size(), false);
  for (const RobotPlan& plan : plans) has_plan[plan.robot] = true;
  for (std::size_t robot = 0; robot < robots.size(); ++robot) {
    const Robot& owner = robots[robot];
    if (has_plan[robot] || owner.invalid || owner.committed.empty()) continue;
    plans.push_back({robot, owner.committed_until(), owner.committed});
  }
}

PlannedExecution planned_execution(const std::vector<Robot>& robots, const std::vector<RobotPlan>& plans,
                                   ExecutionPolicy policy, double max_delay, double wait_before_move,
                                   std::vector<Dependency> dependencies) {
  PlannedExecution execution{plans, {}, policy, std::move(dependencies), max_delay};
  // By a clock, added waits absorb delays; without one, they have to last.
  const double added_wait = policy == ExecutionPolicy::dependencies ? wait_before_move : 0.0;
  std::vector<std::size_t> plan_of(robots.size(), 0);
  for (std::size_t k = 0; k < plans.size(); ++k) {
    execution.purposes.push_back(wait_purposes(robots[plans[k].robot], plans[k].actions, added_wait));
    plan_of[plans[k].robot] = k;
  }
  for (Dependency& dependency : execution.dependencies) {
    dependency.gate.robot = plan_of[dependency.gate.robot];
    dependency.until.robot = plan_of[dependency.until.robot];
  }
  return execution;
}

std::optional<ExecutedCollision> find_wall(const ObstacleField& field, std::size_t robot,
                                           const std::vector<Leg>& legs, double radius, double tolerance,
                                           const StopCondition& stop) {
  const double reach = radius - tolerance;
  if (reach <= 0.0) return std::nullopt;
  StopStride stride = StopStride::from_first(stop, kLegsBetweenPolls);
  for (const Leg& leg : legs) {
    if (stride.met_at_step()) break;
    const auto nearest = field.nearest(leg.from, leg.to, reach);
    if (!nearest) continue;
    const double fraction = nearest->point.fraction;
    const double t =
        fraction > 0.0 ? leg.t_begin + elapsed_at(leg, fraction) * (leg.t_end - leg.t_begin) : leg.t_begin;
    const Position where = leg.from + fraction * (leg.to - leg.from);
    return ExecutedCollision{robot, std::nullopt, t, where, radius - nearest->point.distance};
  }
  return std::nullopt;
}

std::optional<ExecutionCollisions> find_collisions(const std::vector<std::vector<Leg>>& legs,
                                                   const std::vector<double>& radii, double tolerance,
                                                   const ObstacleField& field,
                                                   const std::vector<std::size_t>& near_walls,
                                                   const StopCondition& stop) {
  const std::vector<double> tolerances(radii.size(), tolerance);
  const auto clearance = fleet_clearance(legs, {radii, radii}, tolerances, kMaxOverlaps, stop);
  if (!clearance) return std::nullopt;
  ExecutionCollisions found;
  const auto consider = [&](const ExecutedCollision& collision) {
    if (!found.first || is_earlier(collision, *found.first)) found.first = collision;
  };
  for (const Overlap& overlap : clearance->overlaps) {  // at most kMaxOverlaps
    found.pairs.emplace_back(overlap.first, overlap.second);
    const double t = overlap.t_begin;
    const Position a = position_of(legs[overlap.first], t);
    const Position b = position_of(legs[overlap.second], t);
    const double depth = radii[overlap.first] + radii[overlap.second] - overlap.distance;
    consider({overlap.first, overlap.second, t, Position(0.5 * (a + b)), depth});
  }
  std::sort(found.pairs.begin(), found.pairs.end());
  found.pairs.erase(std::unique(found.pairs.begin(), found.pairs.end()), found.pairs.end());
  for (const std::size_t robot : near_walls) {
    const auto wall = find_wall(field, robot, legs[robot], radii[robot], tolerance, stop);
    if (wall) consider(*wall);
  }
  if (stop.met()) return std::nullopt;
  return found;
}

namespace {

/// Runs of one task: few, but enough that the work of handing out tasks is negligible.
constexpr std::size_t kRunsOfATask = 4;
/// Tasks of one round, between which progress is reported: enough for many workers.
constexpr std::size_t kTasksOfARound = 16;
/// Metres by which disks may overlap: the default tolerance of POST /v1/validate, which dependencies may use
/// in full, and as much again for rounding.
constexpr double kTolerance = 2.0 * kMaxTolerance;

/// Adds up the runs in their order.
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
      if (report_.first_collisions.size() < SimulationReport::kMaxListed) {
        report_.first_collisions.push_back({number, *run.collisions.first});
      }
    }
    for (const auto& pair : run.collisions.pairs) ++pairs_[pair];
    if (!run.stuck.empty()) {
      ++report_.totals.deadlocked;
      if (report_.deadlocks.size() < SimulationReport::kMaxListed) {
        report_.deadlocks.push_back({number, run.stuck});
      }
    }
    add_times(run);
  }

  SimulationReport take() {
    for (const auto& [pair, runs] : pairs_) list(SimulationReport::Pair{pair.first, pair.second, runs});
    return std::move(report_);
  }

 private:
  /// Lists the pair if it collides in more runs than a pair that is listed. Call it by ascending robots.
  void list(const SimulationReport::Pair& pair) {
    std::vector<SimulationReport::Pair>& listed = report_.pairs;
    const auto place = std::upper_bound(
        listed.begin(), listed.end(), pair,
        [](const SimulationReport::Pair& a, const SimulationReport::Pair& b) { return a.runs > b.runs; });
    listed.insert(place, pair);
    if (listed.size() > SimulationReport::kMaxListed) listed.pop_back();
  }

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

struct ExecutedRun {
  std::vector<DisturbedActions> disturbed;  // by plan
  std::vector<ExecutedProgress> progress;
};

std::optional<ExecutedRun> execute_run(const SimulatedFleet& fleet, const SimulationSettings& settings,
                                       std::uint64_t number, const StopCondition& stop) {
  auto disturbed =
      draw_disturbances(fleet.execution.plans, settings.disturbance, settings.seed, number, stop);
  if (!disturbed) return std::nullopt;
  auto progress = execute_plans(fleet.execution, *disturbed, stop);
  if (!progress) return std::nullopt;
  return ExecutedRun{std::move(*disturbed), std::move(*progress)};
}

}  // namespace

Simulator::Simulator(const SimulatedFleet& fleet, const SimulationSettings& settings)
    : fleet_(fleet), settings_(settings), field_(fleet.grid), resting_(fleet.robots.size()) {}

std::optional<Simulator> Simulator::make(const SimulatedFleet& fleet, const SimulationSettings& settings,
                                         const StopCondition& stop) {
  if (stop.met()) return std::nullopt;
  Simulator simulator(fleet, settings);
  std::vector<const RobotPlan*> plans(fleet.robots.size(), nullptr);
  for (const RobotPlan& plan : fleet.execution.plans) plans[plan.robot] = &plan;
  for (std::size_t robot = 0; robot < plans.size(); ++robot) {
    const std::vector<Leg> legs = core::execute(fleet.robots[robot], plans[robot]);
    if (plans[robot] == nullptr) simulator.resting_[robot] = legs;
    const bool leaves_path = plans[robot] != nullptr && settings.disturbance.leaves_paths();
    // A robot on its planned path touches a wall whenever the plan does.
    if (leaves_path || find_wall(simulator.field_, robot, legs, fleet.body_radii[robot], kTolerance, stop)) {
      simulator.near_walls_.push_back(robot);
    }
    if (stop.met()) return std::nullopt;
  }
  return simulator;
}

std::optional<Simulator::Run> Simulator::run(std::uint64_t number, const StopCondition& stop) const {
  const std::vector<RobotPlan>& plans = fleet_.execution.plans;
  const auto executed = execute_run(fleet_, settings_, number, stop);
  if (!executed) return std::nullopt;
  Run run;
  std::vector<std::vector<Leg>> legs = resting_;
  for (std::size_t plan = 0; plan < plans.size(); ++plan) {
    const ExecutedProgress& progress = executed->progress[plan];
    const std::size_t robot = plans[plan].robot;
    auto driven =
        executed_legs(fleet_.robots[robot], plans[plan].actions, executed->disturbed[plan], progress, stop);
    if (!driven) return std::nullopt;
    legs[robot] = std::move(*driven);
    run.ends.push_back(progress.end());
    if (!progress.arrived) run.stuck.push_back(plan);
  }
  auto collisions = find_collisions(legs, fleet_.body_radii, kTolerance, field_, near_walls_, stop);
  if (!collisions) return std::nullopt;
  run.collisions = std::move(*collisions);
  return run;
}

std::optional<SimulationTrace> trace_run(const SimulatedFleet& fleet, const SimulationSettings& settings,
                                         std::uint64_t number, std::size_t max_actions,
                                         const StopCondition& stop) {
  const auto executed = execute_run(fleet, settings, number, stop);
  if (!executed) return std::nullopt;
  SimulationTrace trace;
  const std::vector<RobotPlan>& plans = fleet.execution.plans;
  for (std::size_t plan = 0; plan < plans.size(); ++plan) {
    auto actions = disturbed_actions(plans[plan].actions, executed->disturbed[plan], executed->progress[plan],
                                     max_actions, stop);
    if (!actions) return std::nullopt;
    max_actions -= actions->size();
    trace.actions.push_back(std::move(*actions));
  }
  return trace;
}

std::size_t run_in_rounds(const Simulator& simulator, std::size_t begin, std::size_t end,
                          const StopCondition& stop, Executor& executor,
                          const std::function<void(const Simulator::Run&)>& add,
                          const std::function<bool()>& go_on) {
  MemoryAccount* account = MemoryScope::current();
  std::size_t next = begin;
  while (next < end && !stop.met()) {
    if (go_on && !go_on()) break;
    const std::size_t first = next;
    const std::size_t count = std::min(end - first, kRunsOfATask * kTasksOfARound);
    std::vector<std::optional<Simulator::Run>> runs(count);
    executor.run((count + kRunsOfATask - 1) / kRunsOfATask, [&](std::size_t task) {
      const MemoryScope scope(account);
      const std::size_t task_end = std::min(count, (task + 1) * kRunsOfATask);
      for (std::size_t k = task * kRunsOfATask; k < task_end; ++k) runs[k] = simulator.run(first + k, stop);
    });
    for (const auto& run : runs) {
      // Adding up many collisions takes time as well.
      const bool ends = next > 0 && stop.met();
      if (!run || ends) return next;
      add(*run);
      ++next;
    }
  }
  return next;
}

SimulationReport simulate(const SimulatedFleet& fleet, const SimulationSettings& settings,
                          const StopCondition& stop, Executor& executor,
                          const std::function<bool(const SimulationProgress&)>& go_on) {
  Study study(fleet, settings.runs);
  const auto simulator = Simulator::make(fleet, settings, stop);
  if (!simulator) return study.take();
  run_in_rounds(
      *simulator, 0, settings.runs, stop, executor, [&](const Simulator::Run& run) { study.add(run); },
      [&] { return !go_on || go_on(study.totals()); });
  return study.take();
}

}  // namespace fleetplan::core
