#include "core/plan/planner.h"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <iterator>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "core/bounds/taut_path_bounds.h"
#include "core/compile/instance.h"
#include "core/explain/stuck.h"
#include "core/explain/triage.h"
#include "core/explain/unavoidable_collisions.h"
#include "core/fleet/plan_state.h"
#include "core/fleet/progress_report.h"
#include "core/lns/large_neighbourhood_search.h"
#include "core/lns/smoothing.h"
#include "core/moves/plan_around_kept.h"
#include "core/moves/prioritized_planning.h"
#include "core/moves/yielding.h"
#include "core/plan/collect_plan.h"
#include "core/plan/kept_plans.h"
#include "core/runtime/budget.h"
#include "core/runtime/memory_account.h"

namespace fleetplan::core {
namespace {

/// Returns the costs of the robots' trajectories, by robot; infinite for robots without one.
std::vector<double> costs_of(const FleetReservations& reservations) {
  std::vector<double> costs(reservations.instance().size(), kForever);
  for (std::size_t i = 0; i < costs.size(); ++i) {
    if (const auto& trajectory = reservations.trajectory(i)) costs[i] = trajectory->cost;
  }
  return costs;
}

/// Returns the objectives of the robots that follow a trajectory.
Objectives objectives_of(const FleetReservations& reservations) {
  Objectives objectives;
  for (std::size_t i = 0; i < reservations.instance().size(); ++i) {
    if (const auto& trajectory = reservations.trajectory(i))
      objectives = including(objectives, trajectory->cost);
  }
  return objectives;
}

/// The robots that triage leaves to be planned.
std::vector<std::size_t> robots_to_plan(const FleetReservations& reservations,
                                        const std::vector<std::optional<Unplanned>>& unplanned) {
  std::vector<std::size_t> movers;
  for (std::size_t i = 0; i < reservations.instance().size(); ++i) {
    const Itinerary& itinerary = reservations.instance().itinerary(i);
    const bool need_not_move = itinerary.is_parked() || (itinerary.is_idle && reservations.stays(i));
    if (!need_not_move && !unplanned[i]) movers.push_back(i);
  }
  return movers;
}

StopCondition briefly(const StopCondition& stop) {
  using Clock = StopCondition::Clock;
  return stop.deadline() == Clock::time_point::max() ? stop
                                                     : stop.until(Clock::now() + budget::kTimeForTheEnd);
}

StopCondition beyond_budget(const StopCondition& stop, std::chrono::milliseconds max_time) {
  using Clock = StopCondition::Clock;
  if (stop.deadline() == Clock::time_point::max() && !stop.cancelled()) return stop;
  const auto now = Clock::now();
  if (stop.cancelled()) return stop.even_if_cancelled(now + max_time).despite_memory();
  return stop.until(std::max(stop.deadline(), now) + max_time).despite_memory();
}

/// Returns a condition that leaves at least a little time for planning.
StopCondition with_least_time(const StopCondition& stop) {
  using Clock = StopCondition::Clock;
  if (stop.cancelled() || stop.deadline() >= Clock::now() + budget::kLeastAroundKept) return stop;
  return stop.until(Clock::now() + budget::kLeastAroundKept);
}

/// Whether all robots keep their previous plans, and no search can change that. A robot with a goal may stay
/// because no plan is possible. It may then be in the way of others.
bool is_final(const KeptPlans& previous, const Problem& problem, const PlanOptions& options,
              const StopCondition& stop) {
  const bool may_improve =
      options.mode == PlanOptions::Mode::anytime && options.replan == PlanOptions::Replan::all;
  const std::vector<Robot>& robots = problem.robots();
  return !previous.kept.empty() && (stop.is_over() || !may_improve) &&
         std::all_of(robots.begin(), robots.end(), [&](const Robot& robot) {
           return !robot.goal || robot.invalid ||
                  previous.contains(static_cast<std::size_t>(&robot - robots.data()));
         });
}

/// Returns the previous plans from which planning begins. With a horizon, robots that keep their plans would
/// block others for good: a robot that could wait before them does not fail, so it is never raised above
/// them. So either all robots keep their plans, or, with PlanOptions::Replan::all, none.
KeptPlans plans_to_begin_with(const Problem& problem, const PlanOptions& options, const StopCondition& stop) {
  KeptPlans previous = keep_previous_plans(problem, options, stop);
  if (!options.horizon || options.replan == PlanOptions::Replan::where_needed) return previous;
  for (std::size_t i = 0; i < problem.robots().size(); ++i) {
    const Robot& robot = problem.robots()[i];
    if (robot.goal && !robot.invalid && !previous.contains(i)) return {{}, previous.cut_off};
  }
  return previous;
}

/// Returns the plans that are kept in every case; none if the check takes too long.
KeptPlans certain_plans(const KeptPlans& previous, const Instance& instance, const StopCondition& stop) {
  if (std::count(previous.kept.begin(), previous.kept.end(), true) == 0) return {};
  KeptPlans certain = keep_if_others_stay(instance.problem(), instance.options(), previous,
                                          beyond_budget(stop, budget::kMaxForPrevious));
  return certain.cut_off ? KeptPlans{} : certain;
}

PrioritizedResult first_plan(PlanState& state, const KeptPlans& previous,
                             const std::vector<std::size_t>& movers, Random& random,
                             const StopCondition& stop, ProgressReport& progress) {
  if (is_final(previous, state.instance().problem(), state.instance().options(), stop)) {
    finish_with_kept_plans(state.reservations(), movers);
    return {};
  }
  const KeptPlans certain = certain_plans(previous, state.instance(), stop);
  if (follow_kept_plans(state.reservations(), previous, certain) == 0) {
    return plan_prioritized(state, movers, random, PlanningTime::until(stop), progress);
  }
  const bool is_spent = stop.met();
  PrioritizedResult result = plan_around_kept(state, movers, certain.kept, random,
                                              PlanningTime::until(with_least_time(stop)), progress);
  result.cut_off = result.cut_off || (is_spent && !result.unplanned.empty());
  return result;
}

/// Returns the robots that large neighbourhood search may plan again. A way that is planned beyond the
/// horizon costs more than its estimate. The cheaper estimate would not help if other robots stand in the
/// way.
std::vector<std::size_t> changeable_robots(const PlanState& state, std::vector<std::size_t> movers) {
  if (const auto& whole = state.whole_way_of()) std::erase(movers, *whole);
  if (state.instance().options().replan == PlanOptions::Replan::where_needed) {
    const FleetReservations& reservations = state.reservations();
    std::erase_if(movers, [&](std::size_t robot) { return reservations.trajectory(robot)->is_previous; });
  }
  return movers;
}

/// The effort for undoing the vain moves of one robot. Whether a robot without goals of its own may stay
/// where it is takes none.
constexpr std::int64_t kMaxExpansions = 2'000;
/// Seconds: a gain below this is rounding.
constexpr double kLeastGain = 1e-6;

/// Plans a robot that makes way for less cost, if that takes no more than `expansions_left`. Returns whether
/// it has found such a plan.
bool undo_vain_move(PlanState& state, std::size_t robot, std::int64_t& expansions_left,
                    const StopCondition& stop) {
  SearchSettings settings;
  settings.bound = state.reservations().trajectory(robot)->cost - kLeastGain;
  settings.max_expansions = std::max<std::int64_t>(expansions_left, 1);
  const SearchResult result = state.replan(robot, settings, stop);
  expansions_left -= result.expansions;
  return result.trajectory.has_value();
}

/// Lets robots that make way (Robot::yields) stay where they are done, or nearer, if the other robots of the
/// plan in `state` no longer need the move. Repeats this until no such robot is left. Previous plans are left
/// as they are. Returns whether `stop` ended it early.
bool undo_vain_moves(PlanState& state, const StopCondition& stop) {
  FleetReservations& reservations = state.reservations();
  std::vector<std::size_t> robots;
  for (std::size_t robot = 0; robot < state.instance().size(); ++robot) {
    const bool is_new = makes_way(reservations, robot) && !reservations.trajectory(robot)->is_previous;
    if (is_new) robots.push_back(robot);
  }
  if (robots.empty()) return false;
  if (stop.met()) return true;
  reservations.resume();
  std::vector<std::int64_t> expansions_left(state.instance().size(), kMaxExpansions);
  // Other robots may have made way for a robot that no longer makes way.
  for (bool is_any_undone = true; is_any_undone;) {
    is_any_undone = false;
    for (const std::size_t robot : robots) {
      if (stop.met()) return true;
      is_any_undone = undo_vain_move(state, robot, expansions_left[robot], stop) || is_any_undone;
    }
    std::erase_if(robots, [&](std::size_t robot) {
      const bool may_gain = expansions_left[robot] > 0 || state.instance().itinerary(robot).is_idle;
      return !makes_way(reservations, robot) || !may_gain;
    });
  }
  return false;
}

/// Finds the unavoidable collisions. If a robot has no way or no goal, and stays where something passes,
/// `unplanned` names the collision as the reason.
UnavoidableCollisions find_unavoidable(const FleetReservations& reservations,
                                       std::vector<std::optional<Unplanned>>& unplanned,
                                       const StopCondition& stop) {
  const Instance& instance = reservations.instance();
  std::vector<bool> planned(instance.size(), false);
  for (std::size_t i = 0; i < instance.size(); ++i) planned[i] = reservations.trajectory(i).has_value();
  UnavoidableCollisions found =
      unavoidable_collisions(instance.problem(), instance.itineraries(), planned, stop);
  std::vector<std::vector<std::size_t>> others(found.while_staying.size());
  for (const UnavoidableCollision& collision : found.collisions) {
    if (collision.other) others[collision.robot].push_back(*collision.other);
  }
  for (std::size_t i = 0; i < found.while_staying.size(); ++i) {
    const bool has_no_way = !unplanned[i] || unplanned[i]->reason == Unplanned::Reason::blocked_by_robots;
    if (planned[i] || !found.while_staying[i] || !has_no_way) continue;
    std::sort(others[i].begin(), others[i].end());
    unplanned[i] =
        Unplanned{i, Unplanned::Reason::committed_in_the_way,
                  "It cannot leave in time from where the committed motion of another robot, or an "
                  "obstacle, passes.",
                  std::move(others[i])};
  }
  return found;
}

/// Says of a robot that it would come and go for ever that it is stuck.
void name_shuttling(Plan& plan, const PrioritizedResult::Shuttling& shuttling) {
  for (RobotPlan& robot : plan.plans) {
    if (robot.robot != shuttling.robot || !robot.estimated_cost) continue;
    robot.is_stuck = true;
    robot.blocked_by = shuttling.others;
  }
}

/// The parts of the memory of a plan that are large.
struct PlanMemory {
  PlanMemory(const Problem& problem, const PlanOptions& options, const StopCondition& stop)
      : instance(problem, options, stop), state(instance) {}

  const Instance instance;
  PlanState state;
};

/// Returns the plan of a job that has been short of memory, with that as the reason of robots without a plan.
Plan with_spent_memory_named(Plan plan) {
  plan.deterministic = false;
  for (Unplanned& robot : plan.unplanned) {
    if (robot.reason == Unplanned::Reason::budget_exhausted) robot.detail = kMemorySpent;
  }
  return plan;
}

/// Reports improvements to the observer, and the improved plan when the observer wants it.
class ImprovementReport {
 public:
  using CurrentPlan = std::function<Plan(const LnsResult&)>;

  ImprovementReport(const FleetReservations& reservations, ProgressReport& progress, CurrentPlan current_plan)
      : reservations_(reservations), progress_(progress), current_plan_(std::move(current_plan)) {}

  void operator()(const LnsResult& so_far) {
    if (so_far.improvements > reported_) progress_.plan_found(objectives_of(reservations_));
    reported_ = so_far.improvements;
    if (so_far.improvements == shown_ || !progress_.observer()->wants_plan()) return;
    shown_ = so_far.improvements;
    Plan plan = current_plan_(so_far);
    plan.deterministic = false;
    progress_.observer()->show(plan);
  }

 private:
  const FleetReservations& reservations_;
  ProgressReport& progress_;
  const CurrentPlan current_plan_;
  std::int64_t reported_ = 0;  // improvements
  std::int64_t shown_ = -1;
};

}  // namespace

Plan plan(const Problem& problem, const PlanOptions& options, const StopCondition& stop) {
  CallerThread executor;
  return plan(problem, options, stop, executor);
}

Plan plan(const Problem& problem, const PlanOptions& options, const StopCondition& stop, Executor& executor,
          Observer* observer, PartTimer* timer) {
  const auto memory = std::make_shared<PlanMemory>(problem, options, stop);
  const Instance& instance = memory->instance;
  PlanState& state = memory->state;
  ProgressReport progress(state.reservations(), observer);
  Random random(options.seed);

  const KeptPlans previous =
      plans_to_begin_with(problem, options, beyond_budget(stop, budget::kMaxForPrevious));
  std::vector<std::optional<Unplanned>> unplanned = triage(state, stop, previous.kept);
  std::vector<std::size_t> movers = robots_to_plan(state.reservations(), unplanned);
  PrioritizedResult prioritized = first_plan(state, previous, movers, random, stop, progress);
  for (Unplanned& robot : prioritized.unplanned) {
    if (!instance.itinerary(robot.robot).is_idle) unplanned[robot.robot] = std::move(robot);
  }
  std::erase_if(movers, [&](std::size_t robot) { return !state.reservations().trajectory(robot); });
  bool cut_off = undo_vain_moves(state, stop);
  cut_off = smooth_briefly(state, movers, random, stop, progress) || cut_off;
  unplanned = with_zones_named(problem, options, std::move(unplanned), stop);
  const UnavoidableCollisions found =
      find_unavoidable(state.reservations(), unplanned, beyond_budget(stop, budget::kMaxForUnavoidable));
  progress.plan_found(objectives_of(state.reservations()));

  const bool anytime = options.mode == PlanOptions::Mode::anytime;
  if (timer != nullptr) timer->begin(PlanPart::bounds);
  const TautPathBounds bounds(instance, movers, costs_of(state.reservations()),
                              anytime ? after_share(stop, budget::kShareOfBounds) : stop);
  const std::int64_t expansions = state.expansions();
  const auto current_plan = [&](const LnsResult& lns) {
    Plan plan = collect_plan(state.reservations(), unplanned, bounds);
    plan.unavoidable = found.collisions;
    plan.unavoidable_known = found.finished;
    plan.search = {prioritized.attempts, expansions + lns.expansions, lns.improvements, progress.counts()};
    return plan;
  };
  if (timer != nullptr) timer->begin(PlanPart::improve);
  LnsResult lns;
  if (anytime) {
    BeforeRound before_round;
    if (observer != nullptr) before_round = ImprovementReport(state.reservations(), progress, current_plan);
    if (!stop.is_over()) state.reservations().resume();
    const std::vector<std::size_t> changeable = changeable_robots(state, movers);
    progress.count(Method::improvement,
                   {std::ssize(movers), std::ssize(changeable), std::ssize(movers) - std::ssize(changeable)});
    lns = large_neighbourhood_search(state, changeable, bounds, random, executor, stop, before_round);
    cut_off = undo_vain_moves(state, briefly(stop)) || cut_off;
  }

  Plan plan = with_stuck_explained(state, current_plan(lns), briefly(stop));
  if (prioritized.shuttling) name_shuttling(plan, *prioritized.shuttling);
  progress.plan_found(plan.objectives);
  const bool may_plan_more = !plan.unplanned.empty() && (prioritized.cut_off || prioritized.is_limited);
  plan.search.exhausted = !may_plan_more && (anytime ? lns.exhausted : !plan.unplanned.empty());
  cut_off = cut_off || previous.cut_off || prioritized.cut_off || bounds.cut_off() || lns.cut_off;
  plan.deterministic = plan.deterministic && !cut_off && !stop.cancelled();
  keep_for_later(memory);
  return memory_shortages() > 0 ? with_spent_memory_named(std::move(plan)) : plan;
}

}  // namespace fleetplan::core
