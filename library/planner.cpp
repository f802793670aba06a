#include <fleetplan/fleetplan.h>
#include <fleetplan/planner.h>
#include <fleetplan/verify.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <stdexcept>
#include <utility>

#include "core/model/objective_share.h"
#include "core/plan/make_plan.h"
#include "core/runtime/executor.h"
#include "core/runtime/stop_condition.h"
#include "core/verify/verify.h"
#include "library/convert.h"

namespace fleetplan {

namespace {

using Clock = core::StopCondition::Clock;

/// The most time for the check after the budget: there is nobody else who waits.
constexpr std::chrono::milliseconds kPatience{500};

/// Returns the end of a time budget that may be very long.
Clock::time_point end_of(std::chrono::nanoseconds budget, Clock::time_point begin) {
  const auto left = Clock::time_point::max() - begin;
  return budget >= left ? Clock::time_point::max() : begin + budget;
}

class Reporter : public core::PlanObserver {
 public:
  explicit Reporter(const std::function<void(const Progress&)>& progress) : progress_(progress) {}

  void progressed(const core::Progress& progress) override {
    Progress told{progress.attempts, progress.planned, std::nullopt};
    if (progress.best) told.best = Objectives{progress.best->flowtime, progress.best->makespan};
    progress_(told);
  }
  bool wants_plan() override { return false; }
  void show(const core::CheckedPlan& /*plan*/) override {}

 private:
  const std::function<void(const Progress&)>& progress_;
};

core::MadePlan planned(core::PlanTask task, const core::StopCondition& stop, const Control& control) {
  core::CallerThread thread;
  Reporter reporter(control.progress);
  return core::make_plan(std::move(task),
                         {.stop = stop,
                          .patience = {kPatience, kPatience, kPatience, /*despite_cancel=*/true},
                          .executor = thread,
                          .observer = control.progress ? &reporter : nullptr});
}

/// Returns the plan of a call whose stop is requested while the problem is read.
Plan nothing_planned(std::size_t robots) {
  Plan plan;
  plan.deterministic = false;
  for (std::size_t robot = 0; robot < robots; ++robot) {
    plan.unplanned.push_back(
        {robot, Unplanned::Reason::budget_exhausted, "Planning was stopped before it began.", {}});
  }
  return plan;
}

std::vector<core::RobotPlan> core_plans(std::span<const RobotPlan> plans, const library::Frame& frame) {
  std::vector<core::RobotPlan> made;
  for (const RobotPlan& plan : plans) made.push_back(library::plan_of(plan, frame));
  return made;
}

}  // namespace

Plan plan(const Problem& problem, const Options& options, const Control& control) {
  const Clock::time_point begin = Clock::now();
  library::MadeProblem made = library::make_problem(problem, options, control.stop);
  if (!made.faults.empty()) throw InvalidProblem(std::move(made.faults));
  if (!made.problem) return nothing_planned(problem.robots.size());

  core::PlanTask task{std::move(*made.problem), library::options_of(options, library::in_motion(problem))};
  const core::StopCondition stop(end_of(options.time_budget, begin), control.stop);
  const core::MadePlan found = planned(std::move(task), stop, control);
  Plan plan = library::plan_of(found.plan, problem);
  plan.objective_value =
      core::objective_value(found.plan, found.task.problem.robots(), found.task.options.objective);
  plan.search.seconds = std::chrono::duration<double>(found.times.planned - found.times.begun).count();
  if (!found.report) return plan;
  if (!found.report->valid()) {
    throw std::logic_error("fleetplan made a plan that its checker rejects: " +
                           found.report->violations.front().detail);
  }
  plan.verified = true;
  plan.min_clearance = found.report->min_clearance;
  return plan;
}

const RobotPlan* Plan::plan_of(std::size_t robot) const {
  const auto found = std::lower_bound(plans.begin(), plans.end(), robot,
                                      [](const RobotPlan& plan, std::size_t r) { return plan.robot < r; });
  return found != plans.end() && found->robot == robot ? &*found : nullptr;
}

Verification verify(const Problem& problem, std::span<const RobotPlan> plans, const Rules& rules) {
  library::ReadFleet fleet = library::read_fleet(problem);
  if (!fleet.faults.empty()) throw InvalidProblem(std::move(fleet.faults));
  core::CheckRules core_rules;
  core_rules.tolerances.assign(problem.robots.size(), core::Tolerance::of_all(rules.tolerance));
  core_rules.inflation = rules.inflation;
  core_rules.interval_margin = rules.interval_margin;
  core_rules.wait_before_move = rules.wait_before_move;
  core_rules.start_overlap = rules.start_overlap;
  core_rules.horizon = rules.horizon;
  core_rules.exempt = library::unavoidable_of(rules.unavoidable);
  const core::OccupancyGrid grid = library::grid_of(problem.map);
  auto report = core::verify({grid, fleet.robots, fleet.obstacles, &fleet.zones},
                             core_plans(plans, library::Frame(problem.map)), core_rules,
                             core::StopCondition(end_of(rules.time_budget, Clock::now()), rules.stop));
  return report ? library::verification_of(std::move(*report)) : Verification();
}

Verification verify(const Problem& problem, const Plan& plan, const Options& options) {
  Rules rules;
  rules.interval_margin = options.interval_margin;
  rules.start_overlap = options.start_overlap;
  rules.horizon = options.horizon;
  rules.unavoidable = plan.unavoidable;
  return verify(problem, std::span(plan.plans), rules);
}

const char* version() { return FLEETPLAN_VERSION; }

}  // namespace fleetplan
