#include "api/endpoints/check_plans.h"

#include <chrono>

#include "api/endpoints/within_memory.h"
#include "api/json/fault_text.h"
#include "api/response/error.h"
#include "core/runtime/memory_account.h"

namespace fleetplan::api {

namespace {

/// The answer when the check was stopped.
Reply unfinished(const ValidateRequest& request, const core::StopCondition& stop,
                 const std::string& request_id) {
  if (stop.cancelled()) {
    return problem_reply(ErrorCode::draining, "The service is shutting down.", request_id);
  }
  const auto ms = std::chrono::duration<double, std::milli>(request.budget).count();
  return problem_reply(
      ErrorCode::check_unfinished,
      "The plans could not be checked within " + number_text(ms) +
          " ms: increase options.time_budget_ms, up to max_budget_ms of /v1/limits, or send fewer "
          "robots or a shorter part of the plans.",
      request_id);
}

bool takes_turn(Turn& turn, const ValidateRequest& request, const core::StopCondition& stop) {
  std::size_t work = request.robots.size();
  for (const core::RobotPlan& plan : request.plans) work += plan.actions.size();
  return turn.request({TurnNeed::Kind::check, stop, stop.deadline(), static_cast<double>(work), true}) &&
         turn.await();
}

Reply check(std::string_view body, const RequestContext& context, const AfterCheck& after) {
  const auto request = parse_validate_request(body, context.limits, context.parse_stop());
  if (!request) return problem_reply(request.failure(), context.request_id);
  const core::StopCondition stop(context.received_at + request->budget, context.stop);
  if (context.turn != nullptr && !takes_turn(*context.turn, *request, stop)) {
    return stop.cancelled() ? unfinished(*request, stop, context.request_id) : too_busy(context.request_id);
  }
  const auto report = core::verify({request->grid, request->robots, request->obstacles, &request->zones},
                                   request->plans, request->rules, stop);
  if (!report && core::memory_shortages() > 0) return memory_exceeded(context);
  if (!report) return unfinished(*request, stop, context.request_id);
  return after(*request, *report, stop);
}

}  // namespace

Reply check_plans(std::string_view body, const RequestContext& context, const AfterCheck& after) {
  return within_memory(context, [&] { return check(body, context, after); });
}

}  // namespace fleetplan::api
