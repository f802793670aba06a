#pragma once

#include <string_view>

#include "api/endpoints/request_context.h"
#include "api/response/reply.h"

namespace fleetplan::api {

/// POST /v1/export/vda5050: a plan as orders of VDA 5050, a pure function of the body.
Reply vda5050_endpoint(std::string_view body, const RequestContext& context);

}  // namespace fleetplan::api
