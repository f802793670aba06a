// The OpenAPI document has the server's routes, with their methods, and no others.

#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "api/endpoints/endpoints.h"
#include "tests/server/support/declared_routes.h"

namespace fleetplan::server {
namespace TEST_FILE {

TEST(OpenApiRoutes, AreThoseOfTheServer) {
  std::map<std::string, std::string> documented;  // methods by path
  const auto openapi = nlohmann::json::parse(api::openapi_document());
  for (const auto& [path, operations] : openapi.at("paths").items()) {
    ASSERT_EQ(operations.size(), 1U) << path;
    documented[path] = operations.contains("post") ? "POST" : operations.contains("get") ? "GET, HEAD" : "";
  }
  std::map<std::string, std::string> served;
  const DeclaredRoutes declared;
  for (const Route& route : declared.table.routes()) {
    if (route.path != "/") served[route.path] = route.allowed_methods();  // that is the page
  }
  EXPECT_EQ(documented, served);
}

}  // namespace TEST_FILE
}  // namespace fleetplan::server
