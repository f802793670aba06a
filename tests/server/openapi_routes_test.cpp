// The OpenAPI document has the server's routes, with their methods, and no others.

#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "api/endpoints/openapi.h"
#include "server/routes.h"

namespace fleetplan::server {
namespace {

TEST(OpenApiRoutes, AreThoseOfTheServer) {
  std::map<std::string, std::string> documented;  // methods by path
  const auto openapi = nlohmann::json::parse(api::openapi_document());
  for (const auto& [path, operations] : openapi.at("paths").items()) {
    ASSERT_EQ(operations.size(), 1U) << path;
    documented[path] = operations.contains("post") ? "POST" : operations.contains("get") ? "GET, HEAD" : "";
  }
  std::map<std::string, std::string> served;
  for (const Endpoint endpoint : kEndpoints) {
    if (endpoint == Endpoint::unknown || endpoint == Endpoint::page) continue;
    served[std::string(name_of(endpoint))] = allowed_methods(endpoint);
  }
  EXPECT_EQ(documented, served);
}

}  // namespace
}  // namespace fleetplan::server
