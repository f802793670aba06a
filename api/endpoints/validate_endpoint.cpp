#include "api/endpoints/validate_endpoint.h"

#include <chrono>

#include "api/json/fault_text.h"
#include "api/request/parse_validate_request.h"
#include "api/response/error.h"
#include "api/response/write_report.h"
#include "core/verify/verify.h"

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

}  // namespace

Reply validate_endpoint(std::string_view body, const RequestContext& context) {
  const auto request = parse_validate_request(body, context.limits);
  if (!request) return problem_reply(request.failure(), context.request_id);
  if (context.await_turn) {
    context.await_turn(core::StopCondition(RequestContext::Clock::time_point::max(), context.stop));
  }
  const core::StopCondition stop(RequestContext::Clock::now() + request->budget, context.stop);
  const auto report = core::verify(request->grid, request->robots, request->plans, request->tolerance, stop);
  if (!report) return unfinished(*request, stop, context.request_id);
  return {200, kJson, write_report(*report, request->robots)};
}

}  // namespace fleetplan::api
