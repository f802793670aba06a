#pragma once

#include <span>
#include <string_view>

#include "api/response/reply.h"

namespace fleetplan::api {

/// An example request of GET /v1/examples.
struct Example {
  std::string_view name;  // file name in tests/scenarios without .json
  std::string_view body;  // the request, JSON
};

/// All examples by name; embedded from tests/scenarios at build time.
std::span<const Example> examples();

/// GET /v1/examples: `{"examples": [{"name", "title", "description", "robots", "columns", "rows"}]}`.
Reply examples_endpoint();

}  // namespace fleetplan::api
