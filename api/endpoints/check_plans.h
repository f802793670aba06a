#pragma once

#include <functional>
#include <string_view>

#include "api/endpoints/request_context.h"
#include "api/request/parse_validate_request.h"
#include "api/response/reply.h"
#include "core/runtime/stop_condition.h"
#include "core/verify/verify.h"

namespace fleetplan::api {

/// What is made of plans that were checked, until the stop condition is met.
using AfterCheck =
    std::function<Reply(const ValidateRequest&, const core::VerifyReport&, const core::StopCondition&)>;

/// Reads a body with plans, waits for its turn and checks them. The reply is that of `after`, or the problem.
Reply check_plans(std::string_view body, const RequestContext& context, const AfterCheck& after);

}  // namespace fleetplan::api
