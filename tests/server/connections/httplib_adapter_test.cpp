// The adapter, with the version of cpp-httplib that is installed: requests reach the handlers of their real
// paths.

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <thread>
#include <vector>

#include "tests/server/support/test_server.h"

namespace fleetplan::server {
namespace TEST_FILE {

constexpr const char* kJsonType = "application/json";

class HttplibAdapterTest : public testing::Test {
 protected:
  std::string detail_of(const std::string& path) {
    const auto result = client.Get(path);
    EXPECT_TRUE(result);
    if (!result) return {};
    EXPECT_EQ(result->status, 404) << path;
    const auto problem = nlohmann::json::parse(result->body, nullptr, false);
    return problem.is_object() ? problem.value("detail", "") : "no problem: " + result->body;
  }

  TestServer server;
  httplib::Client client = server.client();
};

TEST_F(HttplibAdapterTest, ReachesTheHandlerOfEveryPath) {
  for (const char* path : {"/v1/examples", "/v1/examples/tiny", "/v1/limits", "/v1/openapi.json", "/healthz",
                           "/readyz", "/metrics"}) {
    const auto get = client.Get(path);
    const auto head = client.Head(path);
    ASSERT_TRUE(get && head) << path;
    EXPECT_EQ(get->status, 200) << path;
    EXPECT_FALSE(get->body.empty()) << path;
    EXPECT_EQ(head->status, 200) << path;
  }
  for (const char* path : {"/v1/plan", "/v1/validate"}) {
    const auto post = client.Post(path, "12", kJsonType);
    ASSERT_TRUE(post) << path;
    EXPECT_EQ(post->body, R"({"size":2})") << path;
  }
}

TEST_F(HttplibAdapterTest, IgnoresTheQueryAndTheWayAPathIsEncoded) {
  for (const char* target : {"/v1/examples/tiny?verbose=1&x", "/v1/examples/%74iny",
                             "/%76%31/examples/tiny?a", "http://localhost/v1/examples/tiny"}) {
    RawConnection raw(server.server.port());
    raw.send(std::string("GET ") + target + " HTTP/1.1\r\nHost: localhost\r\n\r\n");
    const std::string answer = raw.receive();
    EXPECT_EQ(answer.find("HTTP/1.1 200 OK\r\n"), 0U) << target << '\n' << answer;
    EXPECT_NE(answer.find(R"({"robots":[]})"), std::string::npos) << answer;
  }
}

TEST_F(HttplibAdapterTest, PassesAnyNameToTheHandlerUnchanged) {
  const std::vector<std::pair<std::string, std::string>> names{
      {"a%20b%2Fc", "a b/c"}, {"%25u0041", "%u0041"}, {"%2541", "%41"},           {"a+b", "a+b"},
      {"%3Fx%23y", "?x#y"},   {"..%2F..", "../.."},   {"(.*)[a-z]", "(.*)[a-z]"}, {"", ""}};
  for (const auto& [sent, name] : names) {
    EXPECT_EQ(detail_of("/v1/examples/" + sent).find("There is no example '" + name + "'"), 0U) << sent;
  }
}

TEST_F(HttplibAdapterTest, RejectsLongNamesWithoutMatchingThem) {
  const std::string prefix = "/v1/examples/";
  EXPECT_EQ(detail_of(prefix + std::string(1000, 'a')).find("There is no example 'aaa"), 0U);
  EXPECT_EQ(detail_of(prefix + std::string(8000, 'a')).find("There is no resource at '/v1/exam"), 0U);
}

TEST_F(HttplibAdapterTest, KeepsTheExchangesOfConcurrentConnectionsApart) {
  std::vector<std::jthread> threads;
  for (int thread = 0; thread < 8; ++thread) {
    threads.emplace_back([this, thread] {
      auto own = server.client();
      for (int i = 0; i < 50; ++i) {
        const std::string id = std::to_string(thread) + '-' + std::to_string(i);
        const httplib::Headers headers{{"X-Request-Id", id}};
        const std::string body(static_cast<std::size_t>(1 + thread * 50 + i), ' ');
        const auto result = own.Post("/v1/validate", headers, body, kJsonType);
        ASSERT_TRUE(result);
        if (result->status == 503) continue;  // the queue may be full
        EXPECT_EQ(result->get_header_value("X-Request-Id"), id);
        EXPECT_EQ(result->body, R"({"size":)" + std::to_string(body.size()) + "}");
      }
    });
  }
}

}  // namespace TEST_FILE
}  // namespace fleetplan::server
