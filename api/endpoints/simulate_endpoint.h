#pragma once

#include <string_view>

#include "api/endpoints/request_context.h"
#include "api/response/reply.h"

namespace fleetplan::api {

/// POST /v1/simulate: executes plans many times with other disturbances. Reports progress to the context's
/// events.
Reply simulate_endpoint(std::string_view body, const RequestContext& context);

}  // namespace fleetplan::api
