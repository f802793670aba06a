#pragma once

#include <string_view>

#include "api/reply.h"
#include "api/request_context.h"

namespace fleetplan::api {

/// POST /v1/plan: parse -> plan -> verify -> write. Never throws for what a client sent; a plan that the
/// checker refuses becomes a 500.
Reply plan_endpoint(std::string_view body, const RequestContext& context);

}  // namespace fleetplan::api
