#include "core/plan/make_plan.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <new>
#include <utility>

#include "core/plan/kept_plans.h"
#include "core/plan/planner.h"
#include "core/runtime/budget.h"
#include "core/runtime/memory_account.h"
#include "core/runtime/memory_lack.h"
#include "core/runtime/shared_turn.h"

namespace fleetplan::core {
namespace {

/// How often other poses are tried for robots that have no plan with theirs.
constexpr int kMaxSecondChoices = 2;

/// Returns when what is decided without a search, at and after the end of `stop`, has to be.
StopCondition::Clock::time_point end_without_search(const StopCondition& stop) {
  if (stop.deadline() == StopCondition::Clock::time_point::max()) return stop.deadline();
  return std::max(stop.deadline(), StopCondition::Clock::now()) + budget::kMaxForPrevious;
}

/// Returns the end of planning, after which the plan is checked; later if there are previous plans.
StopCondition end_of_planning(const StopCondition& stop, const Problem& problem) {
  return have_previous_plans(problem.robots()) ? stop.until(end_without_search(stop)) : stop;
}

/// Checks the plans that the planner shows, and passes them on.
class CheckingObserver final : public Observer {
 public:
  /// Plans are for `task`, and are passed on if fewer robots than `fewer_than` are unplanned.
  CheckingObserver(const PlanTask& task, const PlanMeans& means, const PlanTimes& times,
                   std::size_t fewer_than)
      : task_(task), means_(means), times_(times), fewer_than_(fewer_than) {}

  void progressed(const Progress& progress) override { means_.observer->progressed(progress); }
  bool wants_plan() override { return wants_any_ && means_.observer->wants_plan(); }
  void show(const Plan& plan) override {
    wants_any_ = plan.unplanned.size() < fewer_than_;
    if (!wants_any_) return;
    const PlanTimes times = times_.until(StopCondition::Clock::now());
    const StopCondition planning = end_of_planning(means_.stop, task_.problem);
    const CheckOfPlan check = core::check(plan, task_.problem, task_.options, planning, means_.patience);
    means_.observer->show({task_, check.checked(plan), check.report, times, planning});
  }

 private:
  const PlanTask& task_;
  const PlanMeans& means_;
  const PlanTimes& times_;  // so far
  const std::size_t fewer_than_;
  bool wants_any_ = true;  // improvement plans no further robots
};

/// Whether a robot may have a plan with other poses. What the poses of `any_of` make impossible is known
/// before they are chosen, but not of a pose with a tolerance.
bool may_help(const Unplanned& robot, const std::vector<OpenGoal>& open) {
  using Reason = Unplanned::Reason;
  if (robot.reason == Reason::blocked_by_robots) return true;
  const bool is_of_goal = robot.reason == Reason::goal_blocked || robot.reason == Reason::goal_unreachable;
  return is_of_goal &&
         std::any_of(open.begin(), open.end(), [](const OpenGoal& goal) { return goal.may_widen(); });
}

/// Makes robots that are unplanned because of their poses give up these poses. Returns whether any of them
/// may get another pose.
bool give_up_poses(const Plan& plan, PlanTask& task, const StopCondition& stop) {
  OpenFleet& open = *task.open;
  std::vector<std::size_t> robots;
  std::vector<OpenPlace> places;
  for (const Unplanned& unplanned : plan.unplanned) {
    const std::size_t robot = unplanned.robot;
    if (!may_help(unplanned, open.goals[robot])) continue;
    robots.push_back(robot);
    for (std::size_t k = 0; k < open.goals[robot].size(); ++k) places.push_back({robot, k});
  }
  const double overlap = conditions_of(task.options).wall_overlap_at_goal;
  widen_goals(task.problem.map(), task.problem.zones(), overlap, open.robots, open.goals, places, stop);
  bool any = false;
  for (const std::size_t robot : robots) any = core::give_up_poses(open.goals[robot]) || any;
  return any;
}

/// A task with poses that are chosen, and its plan.
struct Attempt {
  PlanTask task;
  Plan plan;
};

/// Makes the plan of one task.
class PlanMaker {
 public:
  explicit PlanMaker(const PlanMeans& means)
      : means_(means), turn_(means.stop, means.go_on), stop_(means.go_on ? turn_.stop() : means.stop) {}

  MadePlan run(PlanTask task) {
    if (means_.stop.met() && !have_previous_plans(task.problem.robots())) {
      Plan plan = without_search(task);
      return checked({std::move(task), std::move(plan)}, false);
    }
    const bool is_chosen = choose_poses(task);
    Plan first = planned(task, std::numeric_limits<std::size_t>::max());
    Attempt best = with_other_poses({std::move(task), std::move(first)});
    best.plan.deterministic = best.plan.deterministic && is_chosen;
    return checked(std::move(best), true);
  }

 private:
  /// Chooses the poses for open goals by how long robots take. Returns false if that was not finished in
  /// time; then they keep theirs.
  bool choose_poses(PlanTask& task) {
    if (!task.open) return true;
    times_.parts.begin(PlanPart::choose);
    const StopCondition stop = after_share(stop_, budget::kShareOfPoses);
    bool finished = false;
    try {
      auto problem = choose_by_arrival(task.problem, task.options, task.open->robots, task.open->goals,
                                       finished, stop, means_.executor);
      if (problem) task.problem = std::move(*problem);
    } catch (const std::bad_alloc&) {  // not granted to the job
      if (MemoryScope::current() == nullptr) throw;
      finished = false;
    }
    return finished;
  }

  /// Returns the planner's plan, or a plan that needs no search if the memory does not suffice. Plans are
  /// shown only if fewer robots than `fewer_than` are unplanned.
  Plan planned(const PlanTask& task, std::size_t fewer_than) {
    times_.parts.begin(PlanPart::first_plan);
    std::optional<CheckingObserver> checking;
    if (means_.observer != nullptr) checking.emplace(task, means_, times_, fewer_than);
    Observer* observer = checking ? &*checking : nullptr;
    const std::int64_t lacks = memory_lacks();
    try {
      if (means_.planner) return means_.planner(task.problem, task.options, stop_, observer);
      return plan(task.problem, task.options, stop_, means_.executor, observer, &times_.parts);
    } catch (const std::bad_alloc&) {
      if (MemoryScope::current() == nullptr || memory_lacks() > lacks) throw;
      const StopCondition end = stop_.even_if_cancelled(end_without_search(stop_)).despite_memory();
      return plan_without_search(task.problem, task.options, kMemorySpent, end);
    }
  }

  /// Returns the plan, or a plan with other poses for open goals in which fewer robots are unplanned.
  Attempt with_other_poses(Attempt best) {
    for (int k = 0; best.task.open && !best.plan.unplanned.empty() && k < kMaxSecondChoices; ++k) {
      PlanTask other = best.task;
      if (!give_up_poses(best.plan, other, stop_)) break;
      if (stop_.met() || !choose_poses(other)) {
        best.plan.deterministic = false;
        break;
      }
      Plan with_others = planned(other, best.plan.unplanned.size());
      if (with_others.unplanned.size() >= best.plan.unplanned.size()) {
        best.plan.deterministic = best.plan.deterministic && with_others.deterministic;
        break;
      }
      best = {std::move(other), std::move(with_others)};
    }
    return best;
  }

  Plan without_search(const PlanTask& task) const {
    const char* detail = means_.stop.cancelled() ? "Planning was stopped before it began."
                                                 : "The time budget was spent before planning could begin.";
    return plan_without_search(
        task.problem, task.options, detail,
        means_.stop.even_if_cancelled(StopCondition::Clock::now() + budget::kMaxForPrevious));
  }

  MadePlan checked(Attempt made, bool is_searched) const {
    const PlanTimes times = times_.until(StopCondition::Clock::now());
    StopCondition planning = end_of_planning(means_.stop, made.task.problem);
    CheckOfPlan check =
        core::check(made.plan, made.task.problem, made.task.options, planning, means_.patience);
    if (check.instead) made.plan = std::move(*check.instead);
    return {std::move(made.task), std::move(made.plan), std::move(check.report), times,
            std::move(planning),  is_searched};
  }

  const PlanMeans& means_;
  PlanTimes times_{StopCondition::Clock::now()};
  SharedTurn turn_;
  const StopCondition stop_;  // shares the turn
};

}  // namespace

MadePlan make_plan(PlanTask task, const PlanMeans& means) { return PlanMaker(means).run(std::move(task)); }

}  // namespace fleetplan::core
