#include <algorithm>
#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "api/endpoints/endpoints.h"
#include "api/endpoints/pipeline.h"
#include "api/endpoints/request_context.h"
#include "api/json/errors.h"
#include "api/request/parse_request.h"
#include "api/response/reply.h"
#include "api/response/write_response.h"
#include "core/compile/instance.h"
#include "core/execution/wait_reasons.h"
#include "core/explain/narrow_places.h"
#include "core/model/objective_share.h"
#include "core/model/plan.h"
#include "core/plan/make_plan.h"
#include "core/runtime/budget.h"
#include "core/runtime/executor.h"
#include "core/runtime/stop_condition.h"
#include "core/verify/verify.h"

namespace fleetplan::api {

Reply rejected_plan(const core::VerifyReport& report, const std::string& request_id) {
  return problem_reply(ErrorCode::internal_error,
                       "The planner made a plan that the checker rejects (" +
                           report.violations.front().detail +
                           "), so it is not returned. This is a bug of the service, not of the request.",
                       request_id);
}

namespace {

/// Returns the 500 for a plan that the checker rejects.
Reply rejected(PlanOutcome outcome, const core::VerifyReport& report, const std::string& request_id) {
  Reply reply = rejected_plan(report, request_id);
  outcome.status = PlanOutcome::Status::refused;
  reply.outcome = outcome;
  return reply;
}

/// Returns the 422 for a request whose robots and moving obstacles take too long to compare with each other.
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

/// Returns the spacings of the lattices by robot, metres; none if all are simply the map's resolution.
std::vector<double> reported_spacings(const core::PlanTask& task) {
  std::vector<double> spacings = core::lattice_spacings(task.problem, task.options);
  const double resolution = task.problem.grid().resolution();
  const bool is_plain =
      !task.options.lattice_spacing &&
      std::all_of(spacings.begin(), spacings.end(), [&](double spacing) { return spacing == resolution; });
  return is_plain ? std::vector<double>() : spacings;
}

/// Returns the dependencies of the answer; none if they are not asked for. They have to be made within the
/// budget.
std::optional<PlanDependencies> answer_dependencies(const core::CheckedPlan& made, const PlanRequest& request,
                                                    const StageTimes& stages) {
  if (!request.dependencies.wanted) return std::nullopt;
  const core::Problem& problem = made.task.problem;
  const core::StopCondition stop = made.planning.until(stages.received + request.budget);
  return plan_dependencies(problem.robots(), made.plan.plans, request.dependencies, core::kMaxTolerance,
                           !problem.obstacles().empty(), stop);
}

/// Returns whom robots wait for; none if the dependencies are not known, or if that is not found within the
/// budget.
std::optional<std::vector<std::vector<core::WaitReason>>> reasons_of_waits(
    const core::CheckedPlan& made, const PlanRequest& request,
    const std::optional<PlanDependencies>& dependencies, const StageTimes& stages) {
  if (!dependencies || !dependencies->made) return std::nullopt;
  const core::PlanOptions& options = made.task.options;
  return core::wait_reasons(made.task.problem.robots(), made.plan.plans, *dependencies->made,
                            options.wait_before_move, options.interval_margin,
                            made.planning.until(stages.received + request.budget));
}

/// Returns the value of the objective; none where the flowtime or the makespan of the answer has it.
std::optional<double> objective_value(const core::CheckedPlan& made) {
  const std::vector<core::Robot>& robots = made.task.problem.robots();
  const core::PlanOptions::Objective objective = made.task.options.objective;
  const bool is_told =
      objective == core::PlanOptions::Objective::tardiness ||
      std::any_of(robots.begin(), robots.end(), [](const core::Robot& robot) { return robot.weight != 1.0; });
  return is_told ? std::optional(core::objective_value(made.plan, robots, objective)) : std::nullopt;
}

std::vector<std::string> joined(std::vector<std::string> warnings, const std::vector<std::string>& more) {
  warnings.insert(warnings.end(), more.begin(), more.end());
  return warnings;
}

/// Returns a warning that names robots that gain nothing within the horizon; none if there are none.
std::vector<std::string> stuck_warning(const core::Plan& plan, const std::vector<core::Robot>& robots) {
  constexpr std::size_t kMaxNamed = 5;
  std::string names;
  std::size_t count = 0;
  for (const core::RobotPlan& one : plan.plans) {
    if (!one.is_stuck || ++count > kMaxNamed) continue;
    names += (count > 1 ? ", " : "") + in_quotes(robots[one.robot].id);
  }
  if (count == 0) return {};
  if (count > kMaxNamed) names += " and " + std::to_string(count - kMaxNamed) + " more";
  return {"Robots that gain nothing on the way to their goals within the horizon: " + names +
          ". blocked_by of their plans has the robots that are in their way."};
}

}  // namespace

Reply plan_answer(const core::CheckedPlan& made, const PlanRequest& request, const std::string& request_id,
                  StageTimes stages, const AnsweredPlan& on_answer,
                  std::optional<PlanDependencies> dependencies) {
  stages.planned = made.times.planned;
  stages.parts = made.times.parts;
  const core::Problem& problem = made.task.problem;
  const auto& report = made.report;
  const PlanOutcome outcome =
      outcome_of(made.plan, std::chrono::duration<double>(stages.planned - stages.started).count());
  if (!report && made.planning.cancelled())
    return problem_reply(ErrorCode::draining, kDrainingDetail, request_id);
  if (!report) return unchecked(outcome, !problem.obstacles().empty(), request_id);
  if (!report->valid()) return rejected(outcome, *report, request_id);
  if (!dependencies) dependencies = answer_dependencies(made, request, stages);
  std::vector<std::string> warnings = joined(request.warnings, stuck_warning(made.plan, problem.robots()));
  if (dependencies) warnings = joined(std::move(warnings), dependencies->warnings);
  const auto reasons = reasons_of_waits(made, request, dependencies, stages);
  stages.verified = StageTimes::Clock::now();
  if (on_answer) on_answer(problem, made.plan);
  const VerifiedPlan verified{
      .plan = made.plan,
      .report = *report,
      .problem = problem,
      .received = request.received,
      .origin = request.frame.origin,
      .warnings = warnings,
      .metadata = request.metadata,
      .lattice_spacings = reported_spacings(made.task),
      .dependencies = dependencies ? &dependencies->made : nullptr,
      .wait_reasons = reasons ? &*reasons : nullptr,
      .objective_value = objective_value(made),
      .narrow_places = core::narrow_places(problem, made.task.options, made.plan.unplanned, made.planning)};
  std::string text = write_response(verified, request_id, stages);
  return {.status = 200, .content_type = kJson, .body = std::move(text), .outcome = outcome};
}

namespace {

using Clock = RequestContext::Clock;

/// Returns what the division of its budget depends on. `begin`: of reading.
core::budget::Request measure_of(const PlanRequest& request, const StageTimes& stages,
                                 StageTimes::Time begin) {
  const core::OccupancyGrid& grid = request.problem.grid();
  return {.budget = request.budget,
          .reading = stages.parsed - begin,
          .until_read = stages.parsed - stages.received,
          .robots = request.problem.robots().size(),
          .is_large_map = grid.columns() > core::budget::kManyCells / grid.rows(),
          .has_obstacles = !request.problem.obstacles().empty()};
}

/// Returns what is kept of the budget for the answer.
std::chrono::nanoseconds kept_for_answer(const PlanRequest& request, const core::budget::Request& measure) {
  const auto kept = core::budget::kept_for_answer(measure);
  return request.dependencies.wanted ? kept + core::budget::for_dependencies(measure) : kept;
}

/// Returns what the request needs of the server. A few robots on a small map usually take milliseconds.
TurnNeed need_of(const PlanRequest& request, const core::StopCondition& stop, const RequestContext& context) {
  constexpr std::ptrdiff_t kFewRobots = 16;
  constexpr int kFewCells = 100'000;
  const core::OccupancyGrid& grid = request.problem.grid();
  const auto& robots = request.problem.robots();
  const auto moving =
      std::count_if(robots.begin(), robots.end(), [](const core::Robot& robot) { return bool(robot.goal); });
  const bool is_short = moving <= kFewRobots && grid.columns() <= kFewCells / grid.rows();
  return {.kind = TurnNeed::Kind::plan,
          .stop = stop,
          .answer_by = context.received_at + request.budget,
          .work = static_cast<double>(std::max<std::ptrdiff_t>(1, moving)),
          .is_short = is_short};
}

Reply planned(const Planner& planner, std::string_view body, const RequestContext& context,
              core::Work& work) {
  StageTimes stages{.received = context.received_at};
  const auto begin = Clock::now();
  auto request = parse_request(body, context.limits, work, context.maps);
  if (!request) return problem_reply(request.failure(), context.request_id);
  stages.parsed = Clock::now();

  const core::budget::Request measure = measure_of(*request, stages, begin);
  const core::StopCondition stop = work.before_end(kept_for_answer(*request, measure));
  const auto answer = [&](const core::CheckedPlan& made, const AnsweredPlan& on_answer) {
    if (made.task.open) tell_choices(made.task.open->goals, request->received);
    return plan_answer(made, *request, context.request_id, stages, on_answer);
  };
  work.end_reading();
  const bool has_turn = context.turn == nullptr || context.turn->request(need_of(*request, stop, context));
  if (!has_turn) return too_busy(context.request_id);
  std::optional<ProgressReporter> reporter;
  if (context.events != nullptr) {
    const std::size_t robots = request->problem.robots().size();
    context.events->begin({robots});
    reporter.emplace(*context.events, robots, stop.deadline(),
                     [&](const core::CheckedPlan& better) { return answer(better, {}); });
  }
  const bool has_come = context.turn == nullptr || context.turn->await();
  stages.started = Clock::now();
  if (stop.cancelled()) {
    return problem_reply(ErrorCode::draining, kDrainingDetail, context.request_id);
  }
  if (!has_come) return too_busy(context.request_id);
  core::CallerThread callers_thread;
  core::PlanMeans means{.stop = stop,
                        .patience = core::budget::patience_of_service(measure),
                        .executor = context.executor != nullptr ? *context.executor : callers_thread,
                        .observer = reporter ? &*reporter : nullptr,
                        .planner = planner};
  if (context.turn != nullptr) means.go_on = [&] { return share_turn(context.turn); };
  core::PlanTask task{std::move(request->problem), request->options, std::move(request->open)};
  const core::MadePlan made = core::make_plan(std::move(task), means);
  if (reporter && reporter->rejection()) return *reporter->rejection();
  Reply reply = answer(made.checked(), context.answered);
  if (reply.outcome && !made.is_searched) reply.outcome->plan_seconds.reset();
  return reply;
}

}  // namespace

Reply plan_endpoint(std::string_view body, const RequestContext& context) {
  return plan_with({}, body, context);
}

Reply plan_with(const Planner& planner, std::string_view body, const RequestContext& context) {
  return bounded_work(context, [&](core::Work& work) { return planned(planner, body, context, work); });
}

}  // namespace fleetplan::api
