#pragma once

#include <string>
#include <string_view>

#include "api/response/reply.h"

namespace fleetplan::api {

/// The OpenAPI 3.1 document of the whole service: api/openapi.json, embedded at build time.
std::string_view openapi_document();

/// GET /v1/openapi.json.
inline Reply openapi_endpoint() { return {200, kJson, std::string(openapi_document())}; }

}  // namespace fleetplan::api
