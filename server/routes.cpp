#include "server/routes.h"

#include <array>
#include <utility>

namespace fleetplan::server {

namespace {

bool is_on_admin_port(Endpoint endpoint) {
  return endpoint == Endpoint::healthz || endpoint == Endpoint::readyz;
}

Route find_route(std::string_view path) {
  constexpr std::array<std::pair<std::string_view, Endpoint>, 8> kPaths{{
      {"/v1/plan", Endpoint::plan},
      {"/v1/validate", Endpoint::validate},
      {"/v1/examples", Endpoint::example_list},
      {"/v1/limits", Endpoint::limits},
      {"/v1/openapi.json", Endpoint::openapi},
      {"/healthz", Endpoint::healthz},
      {"/readyz", Endpoint::readyz},
      {"/", Endpoint::page},
  }};
  for (const auto& [known, endpoint] : kPaths) {
    if (path == known) return Route{endpoint, std::string(path)};
  }
  constexpr std::string_view kExamples = "/v1/examples/";
  if (path.starts_with(kExamples)) {
    return Route{Endpoint::example, std::string(path.substr(kExamples.size()))};
  }
  return {};
}

}  // namespace

Route find_route(std::string_view path, Port port) {
  Route route = find_route(path);
  return port == Port::main || is_on_admin_port(route.endpoint) ? route : Route{};
}

std::string_view allowed_methods(Endpoint endpoint) {
  return endpoint == Endpoint::plan || endpoint == Endpoint::validate ? "POST" : "GET, HEAD";
}

bool is_allowed(Endpoint endpoint, std::string_view method) {
  if (endpoint == Endpoint::plan || endpoint == Endpoint::validate) return method == "POST";
  return method == "GET" || method == "HEAD";
}

}  // namespace fleetplan::server
