#include "api/endpoints/unfinished_reply.h"

#include <string>

#include "api/endpoints/bounded_work.h"
#include "api/json/fault_text.h"
#include "api/response/error.h"
#include "core/runtime/memory_account.h"

namespace fleetplan::api {

Reply unfinished_reply(std::string_view what, std::chrono::nanoseconds budget,
                       const core::StopCondition& stop, const RequestContext& context) {
  if (stop.cancelled()) return problem_reply(ErrorCode::draining, kDrainingDetail, context.request_id);
  if (core::memory_shortages() > 0) return memory_exceeded(context);
  const auto ms = std::chrono::duration<double, std::milli>(budget).count();
  return problem_reply(
      ErrorCode::check_unfinished,
      std::string(what) + " within " + number_text(ms) +
          " ms: increase options.time_budget_ms, up to max_budget_ms of /v1/limits, or send fewer "
          "robots or a shorter part of the plans.",
      context.request_id);
}

}  // namespace fleetplan::api
