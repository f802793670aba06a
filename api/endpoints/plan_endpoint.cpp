#include <algorithm>
#include <chrono>
#include <cstdint>
#include <functional>
#include <new>
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
#include "core/checked_plan.h"
#include "core/compile/instance.h"
#include "core/model/objective_share.h"
#include "core/model/plan.h"
#include "core/prioritized/narrow_places.h"
#include "core/replan/kept_plans.h"
#include "core/runtime/executor.h"
#include "core/runtime/memory_lack.h"
#include "core/runtime/shared_turn.h"
#include "core/runtime/stop_condition.h"
#include "core/travel/goal_choice.h"
#include "core/verify/verify.h"

namespace fleetplan::api {

namespace {

/// Returns the 500 for a plan that the checker rejects.
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

/// The time to check a plan and write the answer: a twentieth of the budget, but at most what as many robots
/// need whose plans have many moves, as in crowds.
std::chrono::nanoseconds for_answer(const PlanRequest& request) {
  constexpr std::chrono::milliseconds kLeast{25};
  constexpr std::chrono::microseconds kForARobot{400};
  const auto robots = static_cast<std::int64_t>(request.problem.robots().size());
  const std::chrono::nanoseconds most = std::max<std::chrono::nanoseconds>(kLeast, robots * kForARobot);
  return std::min<std::chrono::nanoseconds>(request.budget / 20, most);
}

/// Returns when to give up the check: soon after the end of planning, but not before it has had the CPU time
/// that a thousand robots with few moves need. A plan that was cancelled, as the service drains, may still be
/// checked quickly.
core::StopCondition check_stop(const core::StopCondition& planning, const PlanRequest& request) {
  constexpr std::chrono::milliseconds kMostAfterPlanning{90};
  constexpr std::chrono::milliseconds kLeastCpu{25};
  if (planning.cancelled()) {
    return planning.even_if_cancelled(StageTimes::Clock::now() + kMostAfterPlanning / 2);
  }
  if (planning.deadline() == StageTimes::Clock::time_point::max()) return planning;
  const auto most = std::max<std::chrono::nanoseconds>(kMostAfterPlanning, for_answer(request));
  return planning.until(planning.deadline() + most).with_cpu_time(kLeastCpu);
}

/// Returns when to give up the check of an answer in which no robot moves, if there is no other answer: with
/// the budget, and not too soon after it. The time for reading the request tells how large it is and how busy
/// the machine.
core::StopCondition last_stop(const StageTimes& stages, const core::StopCondition& planning,
                              const PlanRequest& request) {
  constexpr StageTimes::Clock::duration kLeast = std::chrono::milliseconds(200);
  const auto patience = StageTimes::Clock::now() + std::max(kLeast, stages.parsed - stages.received);
  if (planning.cancelled()) return planning.even_if_cancelled(patience).despite_memory();
  const core::StopCondition check = check_stop(planning, request);
  return planning.until(std::max(patience, check.deadline())).despite_memory();
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
std::vector<double> reported_spacings(const PlanRequest& request) {
  std::vector<double> spacings = core::lattice_spacings(request.problem, request.options);
  const double resolution = request.problem.grid().resolution();
  const bool is_plain =
      !request.options.lattice_spacing &&
      std::all_of(spacings.begin(), spacings.end(), [&](double spacing) { return spacing == resolution; });
  return is_plain ? std::vector<double>() : spacings;
}

/// Returns the dependencies of the answer; none if they are not asked for. They have to be made within the
/// budget.
std::optional<PlanDependencies> answer_dependencies(const core::Plan& plan, const PlanRequest& request,
                                                    const StageTimes& stages,
                                                    const core::StopCondition& planning) {
  if (!request.dependencies.wanted) return std::nullopt;
  const core::StopCondition stop = planning.until(stages.received + request.budget);
  return plan_dependencies(request.problem.robots(), plan.plans, request.dependencies, core::kMostTolerance,
                           !request.problem.obstacles().empty(), stop);
}

/// Returns the value of the objective; none where the flowtime or the makespan of the answer has it.
std::optional<double> objective_value(const core::Plan& plan, const PlanRequest& request) {
  const std::vector<core::Robot>& robots = request.problem.robots();
  const core::PlanOptions::Objective objective = request.options.objective;
  const bool is_told =
      objective == core::PlanOptions::Objective::tardiness ||
      std::any_of(robots.begin(), robots.end(), [](const core::Robot& robot) { return robot.weight != 1.0; });
  return is_told ? std::optional(core::objective_value(plan, robots, objective)) : std::nullopt;
}

std::vector<std::string> joined(std::vector<std::string> warnings, const std::vector<std::string>& more) {
  warnings.insert(warnings.end(), more.begin(), more.end());
  return warnings;
}

/// Returns a warning that names robots that gain nothing within the horizon; none if there are none.
std::vector<std::string> stuck_warning(const core::Plan& plan, const std::vector<core::Robot>& robots) {
  constexpr std::size_t kMostNamed = 5;
  std::string names;
  std::size_t count = 0;
  for (const core::RobotPlan& one : plan.plans) {
    if (!one.is_stuck || ++count > kMostNamed) continue;
    names += (count > 1 ? ", " : "") + in_quotes(robots[one.robot].id);
  }
  if (count == 0) return {};
  if (count > kMostNamed) names += " and " + std::to_string(count - kMostNamed) + " more";
  return {"Robots that gain nothing on the way to their goals within the horizon: " + names +
          ". blocked_by of their plans has the robots that are in their way."};
}

/// Checks a plan and writes the answer. A plan that the checker rejects is a bug and becomes a 500. If the
/// check is not finished soon after `stop`, by which the plan was made, the answer has no plan for robots
/// that move: a plan that is not checked is never returned. `stages`: those before the plan was made.
/// `on_answer`, which may be empty, gets the plan of the answer.
Reply plan_answer(const core::Plan& plan, const PlanRequest& request, const std::string& request_id,
                  StageTimes stages, const core::StopCondition& stop, const AnsweredPlan& on_answer) {
  stages.planned = StageTimes::Clock::now();
  const core::CheckOfPlan check =
      core::check(plan, request.problem, request.options, check_stop(stop, request).despite_memory(),
                  [&] { return last_stop(stages, stop, request); });
  const core::Plan& answered = check.checked(plan);
  const auto& report = check.report;
  const PlanOutcome outcome =
      outcome_of(answered, std::chrono::duration<double>(stages.planned - stages.started).count());
  if (!report && stop.cancelled()) return problem_reply(ErrorCode::draining, kDrainingDetail, request_id);
  if (!report) return unchecked(outcome, !request.problem.obstacles().empty(), request_id);
  if (!report->valid()) return rejected(outcome, *report, request_id);
  const auto dependencies = answer_dependencies(answered, request, stages, stop);
  std::vector<std::string> warnings =
      joined(request.warnings, stuck_warning(answered, request.problem.robots()));
  if (dependencies) warnings = joined(std::move(warnings), dependencies->warnings);
  stages.verified = StageTimes::Clock::now();
  if (on_answer) on_answer(request.problem, answered);
  const VerifiedPlan verified{
      .plan = answered,
      .report = *report,
      .problem = request.problem,
      .received = request.received,
      .origin = request.frame.origin,
      .warnings = warnings,
      .metadata = request.metadata,
      .lattice_spacings = reported_spacings(request),
      .dependencies = dependencies ? &dependencies->made : nullptr,
      .objective_value = objective_value(answered, request),
      .narrow_places = core::narrow_places(request.problem, request.options, answered.unplanned, stop)};
  std::string text = write_response(verified, request_id, stages);
  return {.status = 200, .content_type = kJson, .body = std::move(text), .outcome = outcome};
}

using Clock = RequestContext::Clock;

/// Returns the part of the budget for the dependencies of the answer: several times what fleets have needed
/// so far, at most a quarter.
Clock::duration for_dependencies(const PlanRequest& request) {
  if (!request.dependencies.wanted) return Clock::duration::zero();
  constexpr std::chrono::milliseconds kForARobot{4};
  const auto robots = static_cast<std::int64_t>(request.problem.robots().size());
  return std::min<Clock::duration>(request.budget / 4, robots * kForARobot);
}

/// Returns the part of the budget after planning, to check the plan and write the answer: see for_answer();
/// or a quarter of what reading the request took, which tells how large it is and how busy the machine. The
/// unavoidable collisions of robots with moving obstacles, and their check, take up to half as long as
/// reading them; the check of a very large map takes up to as long.
Clock::duration kept_for_answer(const PlanRequest& request, Clock::duration reading) {
  constexpr int kManyCells = 4'000'000;
  const std::chrono::nanoseconds budget = request.budget;
  const core::OccupancyGrid& grid = request.problem.grid();
  const auto for_the_check = [&]() -> Clock::duration {
    if (grid.columns() > kManyCells / grid.rows()) return std::min<Clock::duration>(budget / 2, reading);
    if (!request.problem.obstacles().empty()) return std::min<Clock::duration>(budget / 2, reading / 2);
    return std::min<Clock::duration>(budget / 4, reading / 4);
  };
  return for_dependencies(request) + std::max(for_answer(request), for_the_check());
}

/// Returns what the request needs of the server. A few robots on a small map take milliseconds, as a rule.
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

/// Returns the end of planning, after which the answer is checked; later if there are previous plans.
core::StopCondition end_of_planning(const core::StopCondition& stop, const PlanRequest& request) {
  if (!core::have_previous_plans(request.problem.robots())) return stop;
  return stop.until(std::max(stop.deadline(), Clock::now()) + core::kMostForPrevious);
}

/// Returns the planner's plan, or one that needs no search if the memory does not suffice for any other.
core::Plan plan_or_none(const Planner& planner, const PlanRequest& request, const core::StopCondition& stop,
                        core::Observer* observer) {
  const std::int64_t lacks = core::memory_lacks();
  try {
    return planner(request.problem, request.options, stop, observer);
  } catch (const std::bad_alloc&) {
    if (core::memory_lacks() > lacks) throw;
    const auto patience =
        stop.even_if_cancelled(std::max(stop.deadline(), Clock::now()) + core::kMostForPrevious);
    return core::plan_without_search(request.problem, request.options, core::kMemorySpent,
                                     patience.despite_memory());
  }
}

/// The part of the time for planning in which poses are chosen for goals that may be served at several.
constexpr double kShareForChoices = 0.25;

/// Chooses the poses for open goals by how long robots take. Returns false if that was not finished in time;
/// then they keep those that are near.
bool choose_poses_by_arrival(PlanRequest& request, const core::StopCondition& planning,
                             core::Executor& executor) {
  if (!request.open) return true;
  const core::StopCondition stop = core::after_share(planning, kShareForChoices);
  bool finished = false;
  try {
    auto problem = core::choose_by_arrival(request.problem, request.options, request.open->robots,
                                           request.open->goals, finished, stop, executor);
    if (problem) request.problem = std::move(*problem);
  } catch (const std::bad_alloc&) {  // not granted to the job
    finished = false;
  }
  tell_choices(request);
  return finished;
}

/// How often other poses are tried for robots that have no plan with theirs.
constexpr int kMostSecondChoices = 2;

/// Makes robots that are unplanned because of others give up their poses. Returns whether any of them may get
/// another one.
bool give_up_poses(const core::Plan& plan, PlanRequest& request) {
  bool any = false;
  for (const core::Unplanned& robot : plan.unplanned) {
    if (robot.reason != core::Unplanned::Reason::blocked_by_robots) continue;
    any = core::give_up_poses(request.open->goals[robot.robot]) || any;
  }
  return any;
}

/// Returns the plan, or one with other poses for open goals in which fewer robots are unplanned; then the
/// request has these poses.
core::Plan with_other_poses(core::Plan plan, PlanRequest& request, const core::StopCondition& stop,
                            core::Executor& executor,
                            const std::function<core::Plan(const PlanRequest&)>& plan_anew) {
  for (int k = 0; request.open && !plan.unplanned.empty() && k < kMostSecondChoices; ++k) {
    PlanRequest other = request;
    if (!give_up_poses(plan, other)) break;
    if (stop.met() || !choose_poses_by_arrival(other, stop, executor)) {
      plan.deterministic = false;
      break;
    }
    core::Plan with_others = plan_anew(other);
    if (with_others.unplanned.size() >= plan.unplanned.size()) {
      plan.deterministic = plan.deterministic && with_others.deterministic;
      break;
    }
    plan = std::move(with_others);
    request = std::move(other);
  }
  return plan;
}

Reply planned(const Planner& planner, std::string_view body, const RequestContext& context,
              core::Work& work) {
  StageTimes stages{
      .received = context.received_at, .parsed = {}, .started = {}, .planned = {}, .verified = {}};
  const auto begin = Clock::now();
  auto request = parse_request(body, context.limits, work, context.maps);
  if (!request) return problem_reply(request.failure(), context.request_id);
  stages.parsed = Clock::now();

  const core::StopCondition stop = work.before_end(kept_for_answer(*request, stages.parsed - begin));
  const auto answer = [&](const core::Plan& plan, const AnsweredPlan& on_answer) {
    return plan_answer(plan, *request, context.request_id, stages, end_of_planning(stop, *request),
                       on_answer);
  };
  work.end_reading();
  const bool has_turn = context.turn == nullptr || context.turn->request(need_of(*request, stop, context));
  if (!has_turn) return too_busy(context.request_id);
  std::optional<ProgressReporter> reporter;
  if (context.events != nullptr) {
    const std::size_t robots = request->problem.robots().size();
    context.events->begin({robots});
    reporter.emplace(*context.events, robots, stop.deadline(),
                     [&](const core::Plan& better) { return answer(better, {}); });
  }
  const bool has_come = context.turn == nullptr || context.turn->await();
  stages.started = Clock::now();
  if (stop.cancelled()) {
    return problem_reply(ErrorCode::draining, kDrainingDetail, context.request_id);
  }
  if (!has_come) return too_busy(context.request_id);
  // Previous plans that hold are kept whatever the budget.
  if (stop.met() && !core::have_previous_plans(request->problem.robots())) {
    const auto patience = stop.even_if_cancelled(Clock::now() + core::kMostForPrevious);
    Reply reply =
        answer(core::plan_without_search(request->problem, request->options,
                                         "The time budget was spent before planning could begin.", patience),
               context.answered);
    if (reply.outcome) reply.outcome->plan_seconds.reset();
    return reply;
  }
  core::CallerThread callers_thread;
  core::Executor& executor = context.executor != nullptr ? *context.executor : callers_thread;
  core::SharedTurn turn(stop, [&] { return share_turn(context.turn); });
  const core::StopCondition shared = turn.stop();
  const bool is_chosen = choose_poses_by_arrival(*request, shared, executor);
  const auto plan_with_poses = [&](const PlanRequest& one) {
    return plan_or_none(planner, one, shared, reporter ? &*reporter : nullptr);
  };
  core::Plan plan = with_other_poses(plan_with_poses(*request), *request, shared, executor, plan_with_poses);
  plan.deterministic = plan.deterministic && is_chosen;
  return reporter && reporter->rejection() ? *reporter->rejection() : answer(plan, context.answered);
}

}  // namespace

Reply plan_endpoint(std::string_view body, const RequestContext& context) {
  core::CallerThread callers_thread;
  core::Executor& executor = context.executor != nullptr ? *context.executor : callers_thread;
  const auto planner = [&](const core::Problem& problem, const core::PlanOptions& options,
                           const core::StopCondition& stop, core::Observer* observer) {
    return core::plan(problem, options, stop, executor, observer);
  };
  return plan_with(planner, body, context);
}

Reply plan_with(const Planner& planner, std::string_view body, const RequestContext& context) {
  return bounded_work(context, [&](core::Work& work) { return planned(planner, body, context, work); });
}

}  // namespace fleetplan::api
