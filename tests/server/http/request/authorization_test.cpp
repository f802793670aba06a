// Authentication over real sockets.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/server/support/test_server.h"

namespace fleetplan::server {
namespace TEST_FILE {

constexpr const char* kJsonType = "application/json";

class Authorization : public testing::Test {
 protected:
  static Settings with_token() {
    Settings settings;
    settings.token = std::get<AccessToken>(AccessToken::from_text("open-sesame"));
    settings.web_root = (std::filesystem::path(FLEETPLAN_SOURCE_DIR) / "web").string();
    return settings;
  }

  static httplib::Headers shown(const std::string& authorization) {
    return {{"Authorization", authorization}};
  }

  TestServer server{with_token()};
  httplib::Client client = server.client();
};

TEST_F(Authorization, IsRequiredExceptForHealthAndReadiness) {
  for (const char* path : {"/", "/main.js", "/v1/limits", "/v1/examples", "/v1/examples/tiny", "/metrics",
                           "/nowhere", "/v1/plan"}) {
    const auto refused = client.Get(path);
    ASSERT_TRUE(refused) << path;
    EXPECT_EQ(refused->status, 401) << path;
    const auto problem = nlohmann::json::parse(refused->body);
    EXPECT_EQ(problem["code"], "unauthorized");
    EXPECT_EQ(problem["request_id"], refused->get_header_value("X-Request-Id"));
  }
  const auto job = client.Post("/v1/plan", "abc", kJsonType);
  ASSERT_TRUE(job);
  EXPECT_EQ(job->status, 401);
  for (const char* path : {"/healthz", "/readyz"}) {
    const auto open = client.Get(path);
    ASSERT_TRUE(open);
    EXPECT_EQ(open->status, 200) << path;
  }
}

TEST_F(Authorization, IsRequestedAsBearerAndAsBasic) {
  const auto refused = client.Get("/");
  ASSERT_TRUE(refused);
  EXPECT_THAT(values_of(refused, "WWW-Authenticate"),
              testing::UnorderedElementsAre(R"(Bearer realm="fleetplan")",
                                            R"(Basic realm="fleetplan", charset="UTF-8")"));
}

TEST_F(Authorization, AcceptsTheTokenAsBearerOrAsThePasswordOfBasic) {
  for (const char* right : {"Bearer open-sesame", "Basic YW55b25lOm9wZW4tc2VzYW1l"}) {
    const auto job = client.Post("/v1/plan", shown(right), "abc", kJsonType);
    ASSERT_TRUE(job);
    EXPECT_EQ(job->status, 200) << right;
    const auto page = client.Get("/", shown(right));
    ASSERT_TRUE(page);
    EXPECT_EQ(page->status, 200) << right;
  }
  for (const char* wrong : {"Bearer open-sesam", "Bearer", "open-sesame", "Basic b3Blbi1zZXNhbWU="}) {
    const auto refused = client.Post("/v1/plan", shown(wrong), "abc", kJsonType);
    ASSERT_TRUE(refused);
    EXPECT_EQ(refused->status, 401) << wrong;
    EXPECT_EQ(refused->body.find("sesame"), std::string::npos);
  }
}

TEST_F(Authorization, IsNotRequiredWithoutASetting) {
  const TestServer open;
  const auto limits = open.client().Get("/v1/limits");
  ASSERT_TRUE(limits);
  EXPECT_EQ(limits->status, 200);
}

}  // namespace TEST_FILE
}  // namespace fleetplan::server
