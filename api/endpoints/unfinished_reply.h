#pragma once

#include <chrono>
#include <string_view>

#include "api/endpoints/request_context.h"
#include "api/response/reply.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::api {

/// The reply when a check or a simulation of plans was stopped before it had an answer. `what` begins the
/// sentence: "The plans could not be checked".
Reply unfinished_reply(std::string_view what, std::chrono::nanoseconds budget,
                       const core::StopCondition& stop, const RequestContext& context);

}  // namespace fleetplan::api
