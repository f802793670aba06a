#pragma once

#include <string_view>

#include "api/endpoints/request_context.h"
#include "api/response/reply.h"

namespace fleetplan::api {

/// POST /v1/retime: when robots that execute a plan with dependencies will arrive, and because of whom.
Reply retime_endpoint(std::string_view body, const RequestContext& context);

}  // namespace fleetplan::api
