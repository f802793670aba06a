#include <fleetplan/fleetplan.h>
#include <fleetplan/planner.h>
#include <fleetplan/verify.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <stdexcept>
#include <utility>

#include "core/model/open_goal.h"
#include "core/plan/make_plan.h"
#include "core/runtime/budget.h"
#include "core/runtime/executor.h"
#include "core/runtime/stop_condition.h"
#include "core/verify/verify.h"
#include "library/convert.h"

namespace fleetplan {

namespace {

using Clock = core::StopCondition::Clock;

class Reporter : public core::PlanObserver {
 public:
  explicit Reporter(const std::function<void(const Progress&)>& progress) : progress_(progress) {}

  void progressed(const core::Progress& progress) override { progress_(library::progress_of(progress)); }
  bool wants_plan() override { return false; }
  void show(const core::CheckedPlan& /*plan*/) override {}

 private:
  const std::function<void(const Progress&)>& progress_;
};

core::MadePlan planned(core::PlanTask task, const core::StopCondition& stop, const Control& control) {
  core::CallerThread thread;
  Reporter reporter(control.progress);
  return core::make_plan(std::move(task), {.stop = stop,
                                           .patience = core::budget::patience_of_library(),
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

/// Chooses the pose or place that a visit names. Returns whether the goal has it.
bool choose_for(const Visit& visit, const library::Frame& frame, core::Robot& robot, core::OpenGoal& goal) {
  if (visit.place) {
    const bool may = goal.tolerance > 0.0 && !visit.choice;
    if (!may || !core::take_place(goal, frame.to_core(visit.place->x, visit.place->y))) return false;
  } else {
    if (goal.tolerance > 0.0 || *visit.choice >= goal.poses.size()) return false;
    goal.chosen = *visit.choice;
  }
  core::choose(robot, goal, goal.chosen);
  return true;
}

/// Settles open goals by the visits of the plan. If the visits say nothing about a goal, by its actions.
void settle_choices(const RobotPlan& plan, std::span<const core::Action> actions, const library::Frame& frame,
                    core::Robot& robot, std::vector<core::OpenGoal>& open, const core::StopCondition& stop) {
  bool is_told = false;
  for (const Visit& visit : plan.visits) {
    if (!visit.choice && !visit.place) continue;
    core::OpenGoal* goal = core::find_open(open, visit.goal);
    if (goal == nullptr || !choose_for(visit, frame, robot, *goal)) {
      throw std::invalid_argument("a visit names a pose or a place that its goal does not have");
    }
    goal->is_settled = is_told = true;
  }
  if (is_told) return core::choose_unserved(robot, open, actions, stop);
  // In the problem, a choice is about the robot's own actions.
  for (core::OpenGoal& goal : open) goal.is_told = false;
  core::settle_by_actions(robot, open, actions, true, stop);
}

/// Gives goals with several poses the poses at which the plans serve them. For robots without a plan, the
/// committed actions count.
void settle_choices(std::span<const RobotPlan> plans, const std::vector<core::RobotPlan>& made,
                    const library::Frame& frame, library::ReadFleet& fleet, const core::StopCondition& stop) {
  std::vector<bool> is_planned(fleet.robots.size(), false);
  for (std::size_t k = 0; k < plans.size(); ++k) {
    const std::size_t robot = plans[k].robot;
    if (robot >= fleet.robots.size()) continue;  // a fault, see core::verify
    is_planned[robot] = true;
    settle_choices(plans[k], made[k].actions, frame, fleet.robots[robot], fleet.open[robot], stop);
  }
  for (std::size_t robot = 0; robot < fleet.robots.size(); ++robot) {
    if (is_planned[robot]) continue;
    core::settle_by_actions(fleet.robots[robot], fleet.open[robot], fleet.robots[robot].committed, false,
                            stop);
  }
}

}  // namespace

Plan plan(const Problem& problem, const Options& options, const Control& control) {
  const Clock::time_point begin = Clock::now();
  library::MadeProblem made = library::make_problem(problem, options, control.stop);
  if (!made.faults.empty()) throw InvalidProblem(std::move(made.faults));
  if (!made.task) return nothing_planned(problem.robots.size());

  const core::StopCondition stop(library::end_of(options.time_budget, begin), control.stop);
  const core::MadePlan found = planned(std::move(*made.task), stop, control);
  return library::plan_of(found, problem, made.invalid);
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
  core_rules.goal_overlap = rules.goal_overlap;
  core_rules.horizon = rules.horizon;
  core_rules.exempt = library::unavoidable_of(rules.unavoidable);
  const core::OccupancyGrid grid = library::grid_of(problem.map);
  const core::StopCondition stop(library::end_of(rules.time_budget, Clock::now()), rules.stop);
  const std::vector<core::RobotPlan> made = core_plans(plans, library::Frame(problem.map));
  settle_choices(plans, made, library::Frame(problem.map), fleet, stop);
  for (const std::size_t robot : rules.invalid) {
    if (robot >= fleet.robots.size()) throw std::invalid_argument("there is no such invalid robot");
    fleet.robots[robot].invalid = true;
    fleet.robots[robot].committed.clear();
  }
  auto report = core::verify({grid, fleet.robots, fleet.obstacles, &fleet.zones}, made, core_rules, stop);
  return report ? library::verification_of(std::move(*report)) : Verification();
}

Verification verify(const Problem& problem, const Plan& plan, const Options& options) {
  Rules rules;
  rules.interval_margin = options.interval_margin;
  rules.start_overlap = options.start_overlap;
  rules.goal_overlap = options.goal_overlap;
  rules.horizon = options.horizon;
  rules.unavoidable = plan.unavoidable;
  for (const Unplanned& robot : plan.unplanned) {
    if (robot.reason == Unplanned::Reason::invalid) rules.invalid.push_back(robot.robot);
  }
  return verify(problem, std::span(plan.plans), rules);
}

const char* version() { return FLEETPLAN_VERSION; }

}  // namespace fleetplan
