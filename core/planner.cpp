#include "core/planner.h"

#include <algorithm>
#include <utility>

#include "core/actions.h"
#include "core/search/fleet.h"
#include "core/search/fleet_state.h"
#include "core/search/improve.h"
#include "core/search/prioritized.h"
#include "core/search/taut_bounds.h"
#include "core/search/triage.h"

namespace fleetplan::core {
namespace {

/// Of the time left, so much goes into planning everybody; the rest is for a safe partial plan where that
/// failed.
constexpr double kPatienceShare = 0.6;

/// Of the time left for improving, so much may go into lower bounds first.
constexpr double kBoundsShare = 0.2;

StopCondition until_share_ends(const StopCondition& stop, double share) {
  using Clock = StopCondition::Clock;
  if (stop.deadline() == Clock::time_point::max()) return stop;
  const auto now = Clock::now();
  const auto left = std::chrono::duration_cast<Clock::duration>((stop.deadline() - now) * share);
  return StopCondition(now + left, stop.stop_token());
}

void add(Objectives& total, double cost) {
  total.flowtime += cost;
  total.makespan = std::max(total.makespan, cost);
}

RobotPlan robot_plan(const FleetState& state, std::size_t index) {
  const auto& trajectory = state.trajectory(index);
  if (!trajectory) return {index, 0.0, {}};  // parked
  return {index, trajectory->cost, to_actions(state.fleet().robot(index), *trajectory)};
}

/// Of the robots' trajectories; infinite where there is none.
std::vector<double> costs(const FleetState& state) {
  std::vector<double> costs(state.fleet().size(), kForever);
  for (std::size_t i = 0; i < costs.size(); ++i) {
    if (const auto& trajectory = state.trajectory(i)) costs[i] = trajectory->cost;
  }
  return costs;
}

/// Puts the plans together: a robot that is not in `unplanned` follows its trajectory or is parked.
Plan collect(const FleetState& state, std::vector<std::optional<Unplanned>> unplanned,
             const TautBounds& bounds) {
  Plan plan;
  for (std::size_t i = 0; i < state.fleet().size(); ++i) {
    if (unplanned[i]) {
      plan.unplanned.push_back(std::move(*unplanned[i]));
      continue;
    }
    plan.plans.push_back(robot_plan(state, i));
    add(plan.objectives, plan.plans.back().cost);
    add(plan.lower_bound, bounds[i]);
  }
  return plan;
}

}  // namespace

Plan plan(const Problem& problem, const PlanOptions& options, const StopCondition& stop) {
  CallersThread executor;
  return plan(problem, options, stop, executor);
}

Plan plan(const Problem& problem, const PlanOptions& options, const StopCondition& stop, Executor& executor) {
  const Fleet fleet(problem, options);
  FleetState state(fleet);
  Random random(options.seed);

  std::vector<std::optional<Unplanned>> unplanned = triage(state, stop);
  std::vector<std::size_t> movers;
  for (std::size_t i = 0; i < fleet.size(); ++i) {
    if (fleet.robot(i).goal && !unplanned[i]) movers.push_back(i);
  }
  PrioritizedResult prioritized =
      plan_prioritized(state, movers, random, until_share_ends(stop, kPatienceShare), stop);
  for (Unplanned& robot : prioritized.unplanned) unplanned[robot.robot] = std::move(robot);
  std::erase_if(movers, [&](std::size_t robot) { return !state.trajectory(robot); });
  const bool anytime = options.mode == PlanOptions::Mode::anytime;
  const TautBounds bounds(fleet, movers, costs(state), anytime ? until_share_ends(stop, kBoundsShare) : stop);
  const std::int64_t expansions = state.expansions();
  Improvement improvement;
  if (anytime) improvement = improve(state, movers, bounds, random, executor, stop);

  Plan plan = collect(state, std::move(unplanned), bounds);
  plan.deterministic = !prioritized.cut_off && !bounds.cut_off() && !improvement.cut_off && !stop.cancelled();
  plan.search = {prioritized.attempts, expansions + improvement.expansions, improvement.improvements};
  return plan;
}

}  // namespace fleetplan::core
