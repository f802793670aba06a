#pragma once

#include <string_view>

#include "api/endpoints/request_context.h"
#include "api/response/reply.h"

namespace fleetplan::api {

/// POST /v1/dependencies: the dependencies of any plan that POST /v1/validate accepts.
Reply dependencies_endpoint(std::string_view body, const RequestContext& context);

}  // namespace fleetplan::api
