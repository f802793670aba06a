#pragma once

#include <string_view>

#include "api/endpoints/request_context.h"
#include "api/response/reply.h"

namespace fleetplan::api {

/// POST /v1/validate: checks any plan from anywhere.
Reply validate_endpoint(std::string_view body, const RequestContext& context);

}  // namespace fleetplan::api
