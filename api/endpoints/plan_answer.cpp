#include "api/endpoints/plan_answer.h"

#include <algorithm>
#include <chrono>
#include <optional>
#include <utility>
#include <vector>

#include "api/endpoints/plan_dependencies.h"
#include "api/response/error.h"
#include "core/instance/instance.h"
#include "core/instance/meetings.h"
#include "core/verify/verify.h"

namespace fleetplan::api {

namespace {

/// The 500 for a plan that the checker rejects.
Reply rejected(PlanOutcome outcome, const core::VerifyReport& report, const std::string& request_id) {
  Reply reply =
      problem_reply(ErrorCode::internal_error,
                    "The planner made a plan that the checker rejects (" + report.violations.front().detail +
                        "), so it is not returned. This is a bug of the service, not of the request.",
                    request_id);
  outcome.status = PlanOutcome::Status::refused;
  reply.outcome = outcome;
  return reply;
}

/// When to give up the check. A plan that was cancelled, as the service drains, may still be checked quickly.
core::StopCondition check_stop(const core::StopCondition& planning) {
  using Clock = core::StopCondition::Clock;
  constexpr std::chrono::milliseconds kMostAfterPlanning{90};
  if (planning.cancelled()) {
    return core::StopCondition::even_if_cancelled(Clock::now() + kMostAfterPlanning / 2);
  }
  if (planning.deadline() == Clock::time_point::max()) return planning;
  return planning.until(planning.deadline() + kMostAfterPlanning);
}

/// When to give up the check of an answer in which nobody moves, if there is no other: with the budget, and
/// not too soon after it. Reading the request tells how large it is and how busy the machine.
core::StopCondition last_stop(const Stages& stages, const core::StopCondition& planning) {
  constexpr Stages::Clock::duration kLeast = std::chrono::milliseconds(200);
  const auto patience = Stages::Clock::now() + std::max(kLeast, stages.parsed - stages.received);
  if (planning.cancelled()) return core::StopCondition::even_if_cancelled(patience).despite_memory();
  const core::StopCondition check = check_stop(planning);
  return planning.until(std::max(patience, check.deadline())).despite_memory();
}

/// The 422 for a request whose robots and moving obstacles take too long to compare with each other.
Reply unchecked(PlanOutcome outcome, bool has_obstacles, const std::string& request_id) {
  std::string detail =
      "The check that robots keep their distance was given up after the time budget. It takes longest where "
      "many robots start near each other, as `vicinity`, `inflation` and `start_overlap` allow";
  if (has_obstacles) detail += ", and with many entries of `motion` of obstacles";
  detail += ". Increase options.time_budget_ms, or send fewer robots that start so";
  detail += has_obstacles ? ", fewer entries of `motion`, or smaller obstacles." : ".";
  Reply reply = problem_reply(ErrorCode::check_unfinished, detail, request_id);
  outcome.status = PlanOutcome::Status::refused;
  reply.outcome = outcome;
  return reply;
}

bool moves(const core::RobotPlan& plan, const core::Problem& problem) {
  return plan.actions.size() > problem.robots()[plan.robot].committed.size();
}

/// What is left of a plan when all robots that would move stay at their starts, or at the end of what is
/// committed.
core::Plan without_moves(const core::Plan& plan, const core::Problem& problem,
                         const core::StopCondition& stop) {
  core::Plan left;
  left.deterministic = false;
  left.search = plan.search;
  left.unplanned = plan.unplanned;
  if (plan.estimated) left.estimated = core::Objectives();
  for (const core::RobotPlan& robot : plan.plans) {
    if (!moves(robot, problem)) {
      left.plans.push_back(robot);
      if (left.estimated) left.estimated->flowtime += robot.cost;
    } else {
      left.unplanned.push_back({robot.robot,
                                core::Unplanned::Reason::budget_exhausted,
                                "The time budget ended before the plan was checked.",
                                {}});
    }
  }
  std::sort(left.unplanned.begin(), left.unplanned.end(),
            [](const core::Unplanned& a, const core::Unplanned& b) { return a.robot < b.robot; });
  // A robot that is at its goal, or has none, stays as well.
  core::UnavoidableMeetings found =
      core::unavoidable_meetings(problem, std::vector<bool>(problem.robots().size(), false), stop);
  left.unavoidable = std::move(found.meetings);
  left.meetings_known = found.finished;
  return left;
}

/// The spacing of the lattice, if it is not simply the map's resolution.
std::optional<double> told_spacing(const PlanRequest& request) {
  const double spacing = core::lattice_spacing(request.problem, request.options);
  const bool is_plain = !request.options.lattice_spacing && spacing == request.problem.grid().resolution();
  return is_plain ? std::nullopt : std::optional(spacing);
}

/// Those of the answer, if they are asked for. The budget of the request holds for them.
std::optional<PlanDependencies> asked_dependencies(const core::Plan& plan, const PlanRequest& request,
                                                   const Stages& stages,
                                                   const core::StopCondition& planning) {
  if (!request.dependencies.wanted) return std::nullopt;
  const core::StopCondition stop = planning.until(stages.received + request.budget);
  return plan_dependencies(request.problem.robots(), plan.plans, request.dependencies, core::kMostTolerance,
                           !request.problem.obstacles().empty(), stop);
}

std::vector<std::string> joined(std::vector<std::string> warnings, const std::vector<std::string>& more) {
  warnings.insert(warnings.end(), more.begin(), more.end());
  return warnings;
}

}  // namespace

Reply plan_answer(const core::Plan& plan, const PlanRequest& request, const std::string& request_id,
                  Stages stages, const core::StopCondition& stop, const AnsweredPlan& on_answer) {
  stages.planned = Stages::Clock::now();
  const auto& robots = request.problem.robots();
  const auto check = [&](const core::Plan& checked, const core::StopCondition& patience) {
    return core::check_plan(request.problem, request.options, checked, patience);
  };
  const bool any_moves = std::any_of(plan.plans.begin(), plan.plans.end(), [&](const core::RobotPlan& robot) {
    return moves(robot, request.problem);
  });
  std::optional<core::VerifyReport> report;
  if (any_moves && plan.meetings_known) report = check(plan, check_stop(stop).despite_memory());
  core::Plan less;
  const bool is_whole = report || (!any_moves && plan.meetings_known);
  const core::StopCondition last = last_stop(stages, stop);
  if (!is_whole) less = without_moves(plan, request.problem, last);
  const core::Plan& answered = is_whole ? plan : less;
  if (!report && answered.meetings_known) report = check(answered, last);
  const PlanOutcome outcome =
      outcome_of(answered, std::chrono::duration<double>(stages.planned - stages.started).count());
  if (!report && stop.cancelled()) return problem_reply(ErrorCode::draining, kDrainingDetail, request_id);
  if (!report) return unchecked(outcome, !request.problem.obstacles().empty(), request_id);
  if (!report->valid()) return rejected(outcome, *report, request_id);
  const auto dependencies = asked_dependencies(answered, request, stages, stop);
  const std::vector<std::string> warnings =
      dependencies ? joined(request.warnings, dependencies->warnings) : request.warnings;
  stages.verified = Stages::Clock::now();
  if (on_answer) on_answer(request.problem, answered);
  std::string text = write_response(
      {answered, *report, robots, request.problem.obstacles(), request.received, request.frame.origin,
       warnings, request.metadata, told_spacing(request), dependencies ? &dependencies->made : nullptr},
      request_id, stages);
  return {200, kJson, std::move(text), {}, outcome};
}

}  // namespace fleetplan::api
