#pragma once

#include <string>
#include <string_view>

namespace fleetplan::server {

enum class Endpoint {
  unknown,
  plan,
  validate,
  example_list,
  example,
  limits,
  openapi,
  healthz,
  readyz,
  page
};

/// Which of the server's ports: all, or health, readiness and metrics only.
enum class Port { main, admin };

struct Route {
  Endpoint endpoint = Endpoint::unknown;
  std::string parameter = {};  // the example's name, the page's file
};

/// The fixed routes of a port, by decoded path; files of the page are not among them. Others are unknown.
Route find_route(std::string_view path, Port port);

/// Methods of an endpoint as the Allow header has them.
std::string_view allowed_methods(Endpoint endpoint);

bool is_allowed(Endpoint endpoint, std::string_view method);

}  // namespace fleetplan::server
