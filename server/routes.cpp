#include "server/routes.h"

#include <algorithm>
#include <array>
#include <utility>

#include "server/http/text.h"

namespace fleetplan::server {

namespace {

constexpr std::array<std::pair<std::string_view, Endpoint>, 9> kPaths{{
    {"/v1/plan", Endpoint::plan},
    {"/v1/validate", Endpoint::validate},
    {"/v1/examples", Endpoint::example_list},
    {"/v1/limits", Endpoint::limits},
    {"/v1/openapi.json", Endpoint::openapi},
    {"/healthz", Endpoint::healthz},
    {"/readyz", Endpoint::readyz},
    {"/metrics", Endpoint::metrics},
    {"/", Endpoint::page},
}};

bool is_on_admin_port(Endpoint endpoint) {
  return endpoint == Endpoint::healthz || endpoint == Endpoint::readyz || endpoint == Endpoint::metrics;
}

Route find_route(std::string_view path) {
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

std::string_view name_of(Endpoint endpoint) {
  for (const auto& [path, known] : kPaths) {
    if (endpoint == known) return path;
  }
  return endpoint == Endpoint::example ? "/v1/examples/{name}" : "unknown";
}

std::string_view allowed_methods(Endpoint endpoint) {
  return endpoint == Endpoint::plan || endpoint == Endpoint::validate ? "POST" : "GET, HEAD";
}

bool is_allowed(Endpoint endpoint, std::string_view method) {
  const auto allowed = split(allowed_methods(endpoint), ',');
  return std::find(allowed.begin(), allowed.end(), method) != allowed.end();
}

}  // namespace fleetplan::server
