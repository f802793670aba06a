#include "core/planner.h"

#include <algorithm>
#include <functional>
#include <utility>

#include "core/actions.h"
#include "core/bounds/taut_bounds.h"
#include "core/instance.h"
#include "core/lns/large_neighbourhood_search.h"
#include "core/prioritized/plan_state.h"
#include "core/prioritized/prioritized_planning.h"
#include "core/prioritized/progress_report.h"
#include "core/prioritized/triage.h"

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

/// Rounding may leave a bound a little above the cost that it bounds: it is told as that cost.
RobotPlan robot_plan(const PlanState& state, std::size_t index, double bound) {
  const auto& trajectory = state.trajectory(index);
  if (!trajectory) return {index, 0.0, {}, 0.0};  // parked
  const double cost = trajectory->cost;
  return {index, cost, to_actions(state.instance().robot(index), *trajectory), std::min(bound, cost)};
}

/// Of the robots' trajectories; infinite where there is none.
std::vector<double> costs(const PlanState& state) {
  std::vector<double> costs(state.instance().size(), kForever);
  for (std::size_t i = 0; i < costs.size(); ++i) {
    if (const auto& trajectory = state.trajectory(i)) costs[i] = trajectory->cost;
  }
  return costs;
}

Objectives objectives(const PlanState& state) {
  Objectives total;
  for (std::size_t i = 0; i < state.instance().size(); ++i) {
    if (const auto& trajectory = state.trajectory(i)) add(total, trajectory->cost);
  }
  return total;
}

/// Puts the plans together: a robot that is not in `unplanned` follows its trajectory or is parked.
Plan collect(const PlanState& state, const std::vector<std::optional<Unplanned>>& unplanned,
             const TautBounds& bounds) {
  Plan plan;
  for (std::size_t i = 0; i < state.instance().size(); ++i) {
    if (unplanned[i]) {
      plan.unplanned.push_back(*unplanned[i]);
      continue;
    }
    const RobotPlan& robot = plan.plans.emplace_back(robot_plan(state, i, bounds[i]));
    add(plan.objectives, robot.cost);
    add(plan.lower_bound, robot.lower_bound);
  }
  return plan;
}

/// Tells the observer how far improving has got, and shows it the plan when it wants that.
class Showing {
 public:
  using PlanSoFar = std::function<Plan(const Improvement&)>;

  Showing(const PlanState& state, ProgressReport& progress, PlanSoFar plan_so_far)
      : state_(state), progress_(progress), plan_so_far_(std::move(plan_so_far)) {}

  void operator()(const Improvement& so_far) {
    if (so_far.improvements > told_) progress_.found(objectives(state_));
    told_ = so_far.improvements;
    if (so_far.improvements == shown_ || !progress_.observer()->wants_plan()) return;
    shown_ = so_far.improvements;
    Plan plan = plan_so_far_(so_far);
    plan.deterministic = false;
    progress_.observer()->show(plan);
  }

 private:
  const PlanState& state_;
  ProgressReport& progress_;
  const PlanSoFar plan_so_far_;
  std::int64_t told_ = 0;  // improvements
  std::int64_t shown_ = -1;
};

}  // namespace

Plan plan(const Problem& problem, const PlanOptions& options, const StopCondition& stop) {
  CallerThread executor;
  return plan(problem, options, stop, executor);
}

Plan plan(const Problem& problem, const PlanOptions& options, const StopCondition& stop, Executor& executor,
          Observer* observer) {
  const Instance instance(problem, options);
  PlanState state(instance);
  ProgressReport progress(state, observer);
  Random random(options.seed);

  std::vector<std::optional<Unplanned>> unplanned = triage(state, stop);
  std::vector<std::size_t> movers;
  for (std::size_t i = 0; i < instance.size(); ++i) {
    if (instance.robot(i).goal && !unplanned[i]) movers.push_back(i);
  }
  PrioritizedResult prioritized =
      plan_prioritized(state, movers, random, until_share_ends(stop, kPatienceShare), stop, progress);
  for (Unplanned& robot : prioritized.unplanned) unplanned[robot.robot] = std::move(robot);
  std::erase_if(movers, [&](std::size_t robot) { return !state.trajectory(robot); });
  progress.found(objectives(state));
  const bool anytime = options.mode == PlanOptions::Mode::anytime;
  const TautBounds bounds(instance, movers, costs(state),
                          anytime ? until_share_ends(stop, kBoundsShare) : stop);
  const std::int64_t expansions = state.expansions();
  const auto plan_so_far = [&](const Improvement& improvement) {
    Plan plan = collect(state, unplanned, bounds);
    plan.search = {prioritized.attempts, expansions + improvement.expansions, improvement.improvements};
    return plan;
  };
  Improvement improvement;
  if (anytime) {
    BeforeRound before_round;
    if (observer != nullptr) before_round = Showing(state, progress, plan_so_far);
    improvement = improve(state, movers, bounds, random, executor, stop, before_round);
  }

  Plan plan = plan_so_far(improvement);
  progress.found(plan.objectives);
  plan.deterministic = !prioritized.cut_off && !bounds.cut_off() && !improvement.cut_off && !stop.cancelled();
  return plan;
}

}  // namespace fleetplan::core
