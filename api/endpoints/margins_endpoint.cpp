#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "api/endpoints/endpoints.h"
#include "api/endpoints/pipeline.h"
#include "api/endpoints/request_context.h"
#include "api/execution/execution_requests.h"
#include "core/plan/margins.h"
#include "core/runtime/budget.h"
#include "core/runtime/executor.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::api {

namespace {

/// The share of the memory of a request for plans that wait until they are executed.
constexpr std::size_t kShareOfWaitingPlans = 4;

TurnNeed need_of(const MarginsRequest& request, const core::StopCondition& stop) {
  constexpr double kActionsOfARobot = 20.0;
  const auto robots = static_cast<double>(request.task.plan.problem.robots().size());
  const auto candidates = static_cast<double>(request.task.candidates.size());
  return {.kind = TurnNeed::Kind::simulation,
          .stop = stop,
          .answer_by = stop.deadline(),
          .work = candidates * kActionsOfARobot * robots,
          .is_short = false};
}

core::FoundMargins found_margins(const MarginsRequest& request, const core::StopCondition& stop,
                                 const RequestContext& context) {
  core::CallerThread callers_thread;
  core::MarginMeans means{.planning = core::after_share(stop, core::budget::kShareOfCandidates),
                          .stop = stop,
                          .executor = context.executor != nullptr ? *context.executor : callers_thread,
                          .max_kept = context.limits.max_plan_memory / kShareOfWaitingPlans};
  if (context.turn != nullptr) means.go_on = [&] { return share_turn(context.turn); };
  if (context.events != nullptr) {
    means.progress =
        [&, robots = request.task.plan.problem.robots().size()](const core::MarginProgress& progress) {
          context.events->progress({.robots = robots, .margins = progress});
        };
  }
  return core::find_margins(request.task, means);
}

/// Returns the answer of POST /v1/plan with the best plan.
Reply answer_with(core::TestedPlan& best, MarginsRequest& request, const StageTimes& times,
                  const RequestContext& context) {
  const core::MadePlan& made = best.made;
  if (made.task.open) tell_choices(made.task.open->goals, request.plan.received);
  std::optional<PlanDependencies> dependencies;
  if (best.dependencies) dependencies = PlanDependencies{std::move(best.dependencies), {}};
  StageTimes stages = times;
  stages.started = made.times.begun;
  return plan_answer(made.checked(), request.plan, context.request_id, stages, {}, std::move(dependencies));
}

Reply with_margins(std::string_view body, const RequestContext& context, core::Work& work) {
  StageTimes stages{.received = context.received_at};
  auto request = parse_margins_request(body, context.limits, work, context.maps);
  if (!request) return problem_reply(request.failure(), context.request_id);
  stages.parsed = StageTimes::Clock::now();
  const core::StopCondition stop = work.before_end(core::budget::for_answer_of_runs(request->plan.budget));
  const auto unfinished = [&] {
    return unfinished_reply("The request was not planned with its own options and executed 50 times",
                            "robots or fewer values in \"try\"", request->plan.budget, stop, context);
  };
  work.end_reading();
  if (context.turn != nullptr && !context.turn->request(need_of(*request, stop))) {
    return too_busy(context.request_id);
  }
  if (context.events != nullptr) {
    context.events->begin({.robots = request->task.plan.problem.robots().size(),
                           .margins = core::MarginProgress{.candidates = request->task.candidates.size()}});
  }
  if (context.turn != nullptr && !context.turn->await()) {
    return stop.cancelled() ? unfinished() : too_busy(context.request_id);
  }
  core::FoundMargins found = found_margins(*request, stop, context);
  if (found.rejected) return rejected_plan(*found.rejected, context.request_id);
  if (!found.has_base()) return unfinished();
  std::optional<std::string> plan;
  if (found.plan) {
    Reply answer = answer_with(*found.plan, *request, stages, context);
    if (answer.status != 200) return answer;
    plan = std::move(answer.body);
  }
  return {200, kJson, write_margins(found, *request, plan, context.request_id)};
}

}  // namespace

Reply margins_endpoint(std::string_view body, const RequestContext& context) {
  return bounded_work(context, [&](core::Work& work) { return with_margins(body, context, work); });
}

}  // namespace fleetplan::api
