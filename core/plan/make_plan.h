#pragma once

// The entry to core. It chooses poses for goals that have several, plans, and checks the plan. If time or
// memory does not suffice, it falls back to a plan that needs less.

#include <functional>
#include <optional>

#include "core/model/plan.h"
#include "core/model/plan_options.h"
#include "core/model/problem.h"
#include "core/model/progress.h"
#include "core/plan/checked_plan.h"
#include "core/plan/part_timer.h"
#include "core/runtime/budget.h"
#include "core/runtime/executor.h"
#include "core/runtime/stop_condition.h"
#include "core/travel/goal_choice.h"
#include "core/verify/verify.h"

namespace fleetplan::core {

/// What is planned.
struct PlanTask {
  Problem problem;
  PlanOptions options;
  std::optional<OpenFleet> open = {};  // goals that may be served at several poses; none: there are none
};

/// When a plan was made, and how long each part took.
struct PlanTimes {
  using Time = StopCondition::Clock::time_point;

  explicit PlanTimes(Time begin) : begun(begin), planned(begin), parts(begin) {}
  /// Returns the times if planning ends at this one.
  PlanTimes until(Time end) const {
    PlanTimes ended = *this;
    ended.planned = end;
    ended.parts.begin(PlanPart::first_plan, end);
    return ended;
  }

  Time begun;
  Time planned;  // before the check
  PartTimer parts;
};

/// A plan and the report of its check. Refers to values of make_plan().
struct CheckedPlan {
  const PlanTask& task;  // with the poses that are chosen
  const Plan& plan;
  const std::optional<VerifyReport>& report;  // none: the check was not finished, so nobody may use the plan
  const PlanTimes& times;
  const StopCondition& planning;  // the end of planning; what explains the plan has to be found by then
};

/// Observes a plan while it is made. The thread that called make_plan() calls it and waits for it.
class PlanObserver {
 public:
  PlanObserver() = default;
  PlanObserver(const PlanObserver&) = delete;
  PlanObserver& operator=(const PlanObserver&) = delete;
  virtual ~PlanObserver() = default;

  /// As Observer::progressed().
  virtual void progressed(const Progress& progress) = 0;

  /// Whether to call show() with the current plan, see Observer::wants_plan().
  virtual bool wants_plan() = 0;

  /// Receives the plan that would be returned now, once it has been checked.
  virtual void show(const CheckedPlan& plan) = 0;
};

/// Makes a plan without checking it: plan() with an executor, or a stub in tests.
using Planner = std::function<Plan(const Problem&, const PlanOptions&, const StopCondition&, Observer*)>;

/// How a plan is made: how much time there is, which threads work on it, and who observes it.
struct PlanMeans {
  StopCondition stop;  // the end of planning, unless there are previous plans, see budget.h
  budget::CheckPatience patience;
  Executor& executor;  // its threads make `anytime` and the choice of poses faster, and change nothing
  PlanObserver* observer = nullptr;
  std::function<bool()> go_on = {};  // see SharedTurn; empty: the turn is not shared
  Planner planner = {};              // empty: plan()
};

/// A plan that may be used only if it has a report: the result of its check.
struct MadePlan {
  PlanTask task;  // with the poses that are chosen
  Plan plan;
  std::optional<VerifyReport> report;  // none: not even a plan in which nobody moves could be checked
  PlanTimes times;
  StopCondition planning;   // see CheckedPlan
  bool is_searched = true;  // false: the time was over before planning could begin

  CheckedPlan checked() const { return {task, plan, report, times, planning}; }
};

/// Makes a plan and checks it:
///
/// 1. If `stop` is met and there are no previous plans, nobody moves. Previous plans are kept whatever the
///    budget.
/// 2. Chooses poses of open goals by when robots arrive. If that takes too long, the poses of `task` stay.
/// 3. Plans with plan(), or without search if the memory does not suffice.
/// 4. Robots without a plan exchange their poses for others, at most kMaxSecondChoices times, as long as that
///    makes more plans.
/// 5. Checks the plan. If it takes too long, robots that would move stay (see check()).
///
/// Throws std::bad_alloc if the process lacks memory, rather than the job (see memory_lacks()).
MadePlan make_plan(PlanTask task, const PlanMeans& means);

}  // namespace fleetplan::core
