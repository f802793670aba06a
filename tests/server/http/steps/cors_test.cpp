#include "server/http/steps/cors.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/server/support/test_server.h"

namespace fleetplan::server {
namespace TEST_FILE {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using testing::UnorderedElementsAre;

constexpr const char* kOrigin = "https://fleet.example:8443";
constexpr const char* kJsonType = "application/json";

class CrossOriginPages : public testing::Test {
 protected:
  static Settings open_to(std::vector<std::string> origins) {
    Settings settings;
    settings.cors_origins = std::move(origins);
    return settings;
  }

  static httplib::Headers from(const std::string& origin) { return {{"Origin", origin}}; }

  static httplib::Headers preflight_from(const std::string& origin) {
    return {{"Origin", origin},
            {"Access-Control-Request-Method", "POST"},
            {"Access-Control-Request-Headers", "content-type,authorization"}};
  }
};

TEST_F(CrossOriginPages, GetNoFieldsWithoutASetting) {
  const TestServer server;
  auto client = server.client();
  const auto plain = client.Get("/healthz", from(kOrigin));
  ASSERT_TRUE(plain);
  EXPECT_FALSE(plain->has_header("Access-Control-Allow-Origin"));
  const auto preflight = client.Options("/v1/plan", preflight_from(kOrigin));
  ASSERT_TRUE(preflight);
  EXPECT_EQ(preflight->status, 405);
}

TEST_F(CrossOriginPages, OfANamedOriginMayReadEveryAnswer) {
  const TestServer server(open_to({"https://other.example", kOrigin}));
  auto client = server.client();
  const auto expect_readable = [](const httplib::Result& result, int status) {
    ASSERT_TRUE(result);
    EXPECT_EQ(result->status, status);
    EXPECT_EQ(result->get_header_value("Access-Control-Allow-Origin"), kOrigin);
    EXPECT_EQ(result->get_header_value("Access-Control-Expose-Headers"),
              "X-Request-Id, Retry-After, traceparent");
    EXPECT_THAT(values_of(result, "Vary"), Contains("Origin"));
  };
  expect_readable(client.Post("/v1/plan", from(kOrigin), "abc", kJsonType), 200);
  expect_readable(client.Get("/nowhere", from(kOrigin)), 404);
  expect_readable(client.Post("/v1/plan", from(kOrigin), "throw", kJsonType), 500);
}

TEST_F(CrossOriginPages, OfAnotherOriginMayNotReadAndVaryNamesOrigin) {
  const TestServer server(open_to({kOrigin}));
  auto client = server.client();
  for (const char* other : {"https://fleet.example", "https://evil.example", "null"}) {
    const auto result = client.Post("/v1/plan", from(other), "abc", kJsonType);
    ASSERT_TRUE(result);
    EXPECT_EQ(result->status, 403);
    EXPECT_FALSE(result->has_header("Access-Control-Allow-Origin")) << other;
    EXPECT_THAT(values_of(result, "Vary"), ElementsAre("Origin"));
    const auto read = client.Get("/healthz", from(other));
    ASSERT_TRUE(read);
    EXPECT_EQ(read->status, 200) << "the browser keeps the answer from the page";
    EXPECT_FALSE(read->has_header("Access-Control-Allow-Origin")) << other;
    EXPECT_THAT(values_of(read, "Vary"), UnorderedElementsAre("Accept-Encoding", "Origin"));
    const auto preflight = client.Options("/v1/plan", preflight_from(other));
    ASSERT_TRUE(preflight);
    EXPECT_EQ(preflight->status, 405);
    EXPECT_FALSE(preflight->has_header("Access-Control-Allow-Methods"));
  }
}

TEST_F(CrossOriginPages, GetAnAnswerToTheirPreflight) {
  const TestServer server(open_to({kOrigin}));
  RawConnection raw(server.server.port());
  for (int times = 0; times < 2; ++times) {  // the connection stays open
    raw.send(std::string("OPTIONS /v1/plan HTTP/1.1\r\nHost: localhost\r\nOrigin: ") + kOrigin +
             "\r\nAccess-Control-Request-Method: POST\r\n\r\n");
    const std::string answer = raw.receive();
    EXPECT_THAT(answer, HasSubstr("HTTP/1.1 204 No Content\r\n"));
    EXPECT_THAT(answer, HasSubstr(std::string("Access-Control-Allow-Origin: ") + kOrigin + "\r\n"));
    EXPECT_THAT(answer, HasSubstr("Access-Control-Allow-Methods: POST\r\n"));
    EXPECT_THAT(answer, HasSubstr("Access-Control-Allow-Headers: Accept, Authorization, Content-Encoding, "
                                  "Content-Type, X-Request-Id, traceparent, tracestate\r\n"));
    EXPECT_THAT(answer, HasSubstr("Access-Control-Max-Age: "));
    EXPECT_THAT(answer, Not(HasSubstr("Content-Length")));
    EXPECT_THAT(answer, Not(HasSubstr("Content-Type: ")));
  }
  auto client = server.client();
  const auto limits = client.Options("/v1/limits", preflight_from(kOrigin));
  ASSERT_TRUE(limits);
  EXPECT_EQ(limits->get_header_value("Access-Control-Allow-Methods"), "GET, HEAD");
  const auto nowhere = client.Options("/nowhere", preflight_from(kOrigin));
  ASSERT_TRUE(nowhere);
  EXPECT_EQ(nowhere->status, 404);
}

TEST_F(CrossOriginPages, OfAnyOriginMayReadIfTheSettingIsAStar) {
  const TestServer server(open_to({"*"}));
  const auto result = server.client().Get("/healthz", from("https://any.example"));
  ASSERT_TRUE(result);
  EXPECT_EQ(result->get_header_value("Access-Control-Allow-Origin"), "*");
}

TEST_F(CrossOriginPages, NeedNoTokenForAPreflight) {
  Settings settings = open_to({kOrigin});
  settings.token = std::get<AccessToken>(AccessToken::from_text("token"));
  const TestServer server(settings);
  auto client = server.client();
  const auto preflight = client.Options("/v1/plan", preflight_from(kOrigin));
  ASSERT_TRUE(preflight);
  EXPECT_EQ(preflight->status, 204);
  const auto refused = client.Post("/v1/plan", from(kOrigin), "abc", kJsonType);
  ASSERT_TRUE(refused);
  EXPECT_EQ(refused->status, 401);
  EXPECT_EQ(refused->get_header_value("Access-Control-Allow-Origin"), kOrigin);
}

TEST_F(CrossOriginPages, CannotHaveAServicePlanUnlessTheyAreItsOwn) {
  const TestServer server;
  const std::string host = "localhost:" + std::to_string(server.server.port());
  const auto post = [&](const std::string& fields) {
    RawConnection raw(server.server.port());
    raw.send("POST /v1/plan HTTP/1.1\r\nContent-Type: application/json\r\nContent-Length: 1\r\n" + fields +
             "\r\na");
    return raw.receive();
  };
  const std::string own = "Host: " + host + "\r\nOrigin: ";
  for (const auto& fields : {own + "http://" + host, own + "https://" + host,
                             std::string("Host: localhost\r\nOrigin: http://localhost:80"),
                             std::string("Host: localhost:443\r\nOrigin: https://LOCALHOST")}) {
    EXPECT_THAT(post(fields + "\r\n"), HasSubstr("HTTP/1.1 200 OK\r\n")) << fields;
  }
  for (const char* origin : {"null", "http://evil.example", "http://localhost", "http://localhost:1",
                             "file://", "", "http://localhost:80, http://evil.example"}) {
    const std::string answer = post(own + origin + "\r\n");
    EXPECT_THAT(answer, HasSubstr("HTTP/1.1 403 Forbidden\r\n")) << origin;
    EXPECT_THAT(answer, HasSubstr("foreign_origin")) << origin;
  }
}

TEST(Origin, IsSchemeHostAndPort) {
  for (const char* good : {"*", "https://fleet.example", "http://localhost:3000", "http://[::1]:80"}) {
    EXPECT_EQ(origin_fault(good), std::nullopt) << good;
  }
  for (const char* bad : {"", "fleet.example", "https://", "://fleet.example", "https://fleet.example/",
                          "https://Fleet.example", "https://a.example, https://b.example", "null"}) {
    EXPECT_NE(origin_fault(bad), std::nullopt) << bad;
  }
}

}  // namespace TEST_FILE
}  // namespace fleetplan::server
