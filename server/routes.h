#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace fleetplan::server {

enum class Endpoint { plan, validate, example_list, example, limits, openapi, healthz, readyz, page };

struct Route {
  Endpoint endpoint;
  std::string parameter;  // the example's name, the page's file
};

/// The fixed routes, by decoded path; files of the page are not among them.
std::optional<Route> find_route(std::string_view path);

/// Methods of an endpoint as the Allow header has them.
std::string_view allowed_methods(Endpoint endpoint);

bool is_allowed(Endpoint endpoint, std::string_view method);

}  // namespace fleetplan::server
