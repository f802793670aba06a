#include "api/endpoints/plan_endpoint.h"

#include <algorithm>
#include <chrono>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <variant>

#include "api/endpoints/plan_watch.h"
#include "api/request/parse_request.h"
#include "api/response/error.h"
#include "api/response/write_response.h"
#include "core/geometry/tolerance.h"
#include "core/verify/verify.h"

namespace fleetplan::api {

namespace {

using Clock = RequestContext::Clock;

/// How far off a plan may be: twice the contact that is allowed, as the search and the checker round in their
/// own ways, and what doubles lose in coordinates of the map's size and times as long as the plan's (64 ulp,
/// as both add up many numbers).
double check_tolerance(const core::Problem& problem, const core::Plan& plan) {
  double fastest = 0.0;
  for (const core::Robot& robot : problem.robots()) {
    fastest = std::max({fastest, robot.linear_speed, robot.angular_speed});
  }
  const double extent = std::max(problem.grid().width(), problem.grid().height());
  const double horizon = plan.objectives.makespan * std::max(1.0, fastest);
  constexpr double kRounding = 64.0 * std::numeric_limits<double>::epsilon();
  return 2.0 * core::kContactTolerance + kRounding * std::max(extent, horizon);
}

/// When planning has to end so that there is time left to check the plan and write the answer: a twentieth of
/// the budget, which is plenty, up to what a thousand robots take.
Clock::time_point planning_deadline(const RequestContext& context, std::chrono::nanoseconds budget) {
  constexpr Clock::duration kMostForTheAnswer = std::chrono::milliseconds(25);
  return context.received_at + budget - std::min<Clock::duration>(budget / 20, kMostForTheAnswer);
}

/// The answer when nothing is left of the budget: only the parked robots have plans.
core::Plan nothing_planned(const core::Problem& problem) {
  core::Plan plan;
  plan.deterministic = false;
  for (std::size_t index = 0; index < problem.robots().size(); ++index) {
    if (!problem.robots()[index].goal) {
      plan.plans.push_back({index, 0.0, {}});
    } else {
      plan.unplanned.push_back({index,
                                core::Unplanned::Reason::budget_exhausted,
                                "The time budget was spent before planning could begin.",
                                {}});
    }
  }
  return plan;
}

/// The answer with a plan that the checker accepts; a 500 otherwise. Of the stages, the first ones are known.
Reply checked_answer(const core::Plan& plan, const PlanRequest& request, const std::string& request_id,
                     Stages stages) {
  stages.planned = Clock::now();
  const auto& robots = request.problem.robots();
  const auto report =
      core::verify(request.problem.grid(), robots, plan.plans, check_tolerance(request.problem, plan));
  stages.verified = Clock::now();
  PlanOutcome outcome =
      outcome_of(plan, std::chrono::duration<double>(stages.planned - stages.started).count());
  if (!report.valid()) {
    Reply refused = problem_reply(
        ErrorCode::internal_error,
        "The planner made a plan that the checker refuses (" + report.violations.front().detail +
            "), so it is not returned. This is a bug of the service, not of the request.",
        request_id);
    outcome.status = PlanOutcome::Status::refused;
    refused.outcome = outcome;
    return refused;
  }
  std::string answer =
      write_response({plan, report, robots, request.frame, request.warnings}, request_id, stages);
  return {200, kJson, std::move(answer), {}, outcome};
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
  Stages stages{context.received_at, {}, {}, {}, {}};
  auto parsed = parse_request(body, context.limits);
  if (const auto* error = std::get_if<RequestError>(&parsed)) {
    return problem_reply(error->code, error->detail, context.request_id, error->faults);
  }
  const PlanRequest request = std::get<PlanRequest>(std::move(parsed));
  stages.parsed = Clock::now();

  const core::StopCondition stop(planning_deadline(context, request.budget), context.stop);
  const auto answer = [&](const core::Plan& plan) {
    return checked_answer(plan, request, context.request_id, stages);
  };
  std::optional<PlanWatch> watch;
  if (context.events != nullptr) {
    const std::size_t robots = request.problem.robots().size();
    context.events->begin({robots});
    watch.emplace(*context.events, robots, stop.deadline(), answer);
  }
  if (context.await_turn) context.await_turn(stop);
  stages.started = Clock::now();
  if (stop.cancelled()) {
    return problem_reply(ErrorCode::draining, "The service is shutting down: ask another one.",
                         context.request_id);
  }
  if (stop.met()) {
    Reply late = answer(nothing_planned(request.problem));
    if (late.outcome) late.outcome->plan_seconds.reset();
    return late;
  }
  const core::Plan plan = planner(request.problem, request.options, stop, watch ? &*watch : nullptr);
  return watch && watch->refusal() ? *watch->refusal() : answer(plan);
}

}  // namespace fleetplan::api
