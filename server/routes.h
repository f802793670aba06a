#pragma once

#include <array>
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
  metrics,
  page
};

/// All of them, in their order.
inline constexpr std::array kEndpoints{Endpoint::unknown,      Endpoint::plan,    Endpoint::validate,
                                       Endpoint::example_list, Endpoint::example, Endpoint::limits,
                                       Endpoint::openapi,      Endpoint::healthz, Endpoint::readyz,
                                       Endpoint::metrics,      Endpoint::page};

/// Which of the server's ports: all, or health, readiness and metrics only.
enum class Port { main, admin };

struct Route {
  Endpoint endpoint = Endpoint::unknown;
  std::string parameter = {};  // the example's name, the page's file
};

/// The fixed routes of a port, by decoded path; files of the page are not among them. Others are unknown.
Route find_route(std::string_view path, Port port);

/// For metrics: its path, e.g. "/v1/examples/{name}"; "/" for all files of the page, "unknown" for what leads
/// nowhere.
std::string_view name_of(Endpoint endpoint);

/// Methods of an endpoint as the Allow header has them.
std::string_view allowed_methods(Endpoint endpoint);

/// Whether the method is among them.
bool is_allowed(Endpoint endpoint, std::string_view method);

}  // namespace fleetplan::server
