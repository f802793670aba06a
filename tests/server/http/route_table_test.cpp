#include "server/http/route_table.h"

#include <gtest/gtest.h>

#include <string>

#include "server/http/exchange.h"

namespace fleetplan::server {
namespace TEST_FILE {

const Handler kNoHandler = [](Exchange& /*exchange*/) { return api::Reply{}; };

RouteTable sample_routes() {
  RouteTable routes;
  routes.post("/v1/plan", kNoHandler, {.plans = true});
  routes.get("/v1/openapi.json", kNoHandler);
  routes.get("/v1/examples/{name}", kNoHandler);
  routes.files(
      "/", [](std::string_view path) { return path == "/main.js" || path == "/v1/plan"; }, kNoHandler);
  return routes;
}

std::string path_of(const RouteTable::Match& match) {
  return match.route == nullptr ? "unknown" : match.route->path;
}

TEST(RouteTable, FindsRouteByItsWholePath) {
  const RouteTable routes = sample_routes();
  EXPECT_EQ(path_of(routes.find("/v1/plan")), "/v1/plan");
  for (const char* other : {"", "/v1/plan/", "/v1/pla", "/v1/openapi_json", "/v1/examples", "/other.js"}) {
    EXPECT_EQ(path_of(routes.find(other)), "unknown") << other;
  }
}

TEST(RouteTable, ReturnsTextThatMatchesBracesAsParameter) {
  const RouteTable routes = sample_routes();
  for (const std::string name : {"tiny", "", "a/b c", "{name}"}) {
    const auto match = routes.find("/v1/examples/" + name);
    EXPECT_EQ(path_of(match), "/v1/examples/{name}");
    EXPECT_EQ(match.parameter, name);
  }
}

TEST(RouteTable, FindsFilesAfterTheOtherRoutes) {
  const RouteTable routes = sample_routes();
  for (const char* path : {"/", "/main.js"}) {
    const auto match = routes.find(path);
    EXPECT_EQ(path_of(match), "/") << path;
    EXPECT_EQ(match.parameter, path);
  }
  EXPECT_EQ(routes.find("/v1/plan").route->method, "POST");
}

TEST(RouteTable, RejectsVariablePathThatExceedsLimit) {
  const RouteTable routes = sample_routes();
  const std::string prefix = "/v1/examples/";
  const std::string longest(RouteTable::kMaxVariablePath - prefix.size(), 'a');
  EXPECT_EQ(path_of(routes.find(prefix + longest)), "/v1/examples/{name}");
  EXPECT_EQ(path_of(routes.find(prefix + longest + 'a')), "unknown");
}

TEST(RouteTable, MatchesMarksOfPatternsOnlyWithThemselves) {
  RouteTable routes = sample_routes();
  routes.get("/v1/a.*(b)[c]+", kNoHandler);
  EXPECT_EQ(path_of(routes.find("/v1/a.*(b)[c]+")), "/v1/a.*(b)[c]+");
  for (const char* other : {"/v1/a.*bc", "/v1/abc", "/v1/axxbcc", "/v1/openapi_json", "/main_js"}) {
    EXPECT_EQ(path_of(routes.find(other)), "unknown") << other;
  }
  EXPECT_EQ(path_of(routes.find("/v1/examples/a b/%")), "/v1/examples/{name}");
}

TEST(Route, AllowsHeadWhereItAllowsGet) {
  const RouteTable routes = sample_routes();
  const Route& plan = routes.routes()[0];
  const Route& document = routes.routes()[1];
  EXPECT_TRUE(plan.allows("POST"));
  EXPECT_EQ(plan.allowed_methods(), "POST");
  for (const char* method : {"GET", "HEAD", "post"}) EXPECT_FALSE(plan.allows(method)) << method;
  EXPECT_TRUE(document.allows("GET") && document.allows("HEAD"));
  EXPECT_EQ(document.allowed_methods(), "GET, HEAD");
  EXPECT_FALSE(document.allows("POST"));
}

}  // namespace TEST_FILE
}  // namespace fleetplan::server
