#pragma once

#include <string_view>

#include "api/endpoints/request_context.h"
#include "api/response/reply.h"

namespace fleetplan::api {

/// POST /v1/advance: the request of a later moment, when robots have executed a part of their plans.
Reply advance_endpoint(std::string_view body, const RequestContext& context);

}  // namespace fleetplan::api
