#include "server/http/request/access.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/server/support/test_server.h"
#include "tests/support/temporary_file.h"

namespace fleetplan::server {
namespace TEST_FILE {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using testing::UnorderedElementsAre;

using support::TemporaryFile;

constexpr const char* kToken = "s3cret/token+of~the-house==";

AccessToken token() { return std::get<AccessToken>(AccessToken::from_text(kToken)); }

std::string fault_of(const std::string& path) {
  const auto read = AccessToken::from_file(path);
  return std::holds_alternative<std::string>(read) ? std::get<std::string>(read) : "";
}

TEST(AccessToken, IsAcceptedAsBearer) {
  const AccessToken known = token();
  EXPECT_TRUE(known.admits(std::string("Bearer ") + kToken));
  EXPECT_TRUE(known.admits(std::string("bearer   ") + kToken));
  for (const std::string& wrong :
       {std::string(), std::string("Bearer"), std::string("Bearer "), std::string(kToken),
        std::string("Bearer ") + kToken + "x", std::string("Bearer ") + std::string(kToken).substr(1),
        std::string("Bearer ") + kToken + kToken, std::string("Token ") + kToken,
        std::string("Bearer S3cret/token+of~the-house==")}) {
    EXPECT_FALSE(known.admits(wrong)) << wrong;
  }
}

TEST(AccessToken, IsAcceptedAsThePasswordOfBasic) {
  const AccessToken known = std::get<AccessToken>(AccessToken::from_text("pass:word-of-sixteen"));
  EXPECT_TRUE(known.admits("Basic YW55b25lOnBhc3M6d29yZC1vZi1zaXh0ZWVu"));   // anyone:pass:word-of-sixteen
  EXPECT_TRUE(known.admits("basic OnBhc3M6d29yZC1vZi1zaXh0ZWVu"));           // :pass:word-of-sixteen
  EXPECT_FALSE(known.admits("Basic YW55b25lOnBhc3M6d29yZC1vZi1zaXh0ZWU="));  // without its last letter
  EXPECT_FALSE(known.admits("Basic cGFzczp3b3JkLW9mLXNpeHRlZW4="));          // pass:word-of-sixteen, no user
  EXPECT_FALSE(known.admits("Basic YW55b25l"));                              // no colon
  EXPECT_FALSE(known.admits("Basic ***"));
}

TEST(AccessToken, IsReadFromTheLineOfAFile) {
  const TemporaryFile unix_lines(std::string(kToken) + "\n");
  const TemporaryFile other_lines(std::string(kToken) + "\r\n");
  for (const auto* file : {&unix_lines, &other_lines}) {
    const auto read = AccessToken::from_file(file->path());
    ASSERT_TRUE(std::holds_alternative<AccessToken>(read)) << std::get<std::string>(read);
    EXPECT_TRUE(std::get<AccessToken>(read).admits(std::string("Bearer ") + kToken));
  }
}

TEST(AccessToken, IsRejectedFromABadFileWithoutShowingIt) {
  EXPECT_EQ(fault_of("/no/such/file"), "it cannot be read");
  const TemporaryFile empty("");
  EXPECT_EQ(fault_of(empty.path()), "it is empty");
  const TemporaryFile blank("\n\n");
  EXPECT_EQ(fault_of(blank.path()), "it is empty");
  const TemporaryFile two("first-secret-of-all\nsecond-secret-of-all\n");
  EXPECT_NE(fault_of(two.path()).find("one token"), std::string::npos);
  EXPECT_EQ(fault_of(two.path()).find("secret"), std::string::npos);
  EXPECT_EQ(fault_of("/"), "it cannot be read");
}

TEST(Base64, IsDecoded) {
  EXPECT_EQ(base64_decoded(""), "");
  EXPECT_EQ(base64_decoded("Zg=="), "f");
  EXPECT_EQ(base64_decoded("Zm8="), "fo");
  EXPECT_EQ(base64_decoded("Zm9v"), "foo");
  EXPECT_EQ(base64_decoded("Zm9vYg"), "foob");
  EXPECT_EQ(base64_decoded("/+8="), "\xff\xef");
  EXPECT_EQ(base64_decoded("Z"), std::nullopt);
  EXPECT_EQ(base64_decoded("Zm 9v"), std::nullopt);
}

bool admits(const AllowedHosts& hosts, const std::optional<std::string>& host) {
  RequestHead head;
  head.host = host;
  return hosts.admits(head);
}

TEST(AllowedHosts, OfAServiceOnLoopbackAreLocalNamesAndThoseOfTheSetting) {
  for (const char* listening : {"127.0.0.1", "localhost", "::1"}) {
    const AllowedHosts hosts(listening, {"Fleet.example"});
    for (const char* host : {"localhost", "LOCALHOST:1", "127.0.0.1:8080", "127.1.2.3", "[::1]:80",
                             "fleet.example", "FLEET.EXAMPLE:8080"}) {
      EXPECT_TRUE(admits(hosts, host)) << host;
    }
    for (const char* host : {"", "evil.example", "evil.example:8080", "a.fleet.example",
                             "localhost.evil.example", "10.0.0.1", "127.0.0.1.evil.example"}) {
      EXPECT_FALSE(admits(hosts, host)) << host;
    }
    EXPECT_TRUE(admits(hosts, std::nullopt)) << "HTTP/1.0";
  }
}

TEST(AllowedHosts, AreAllElsewhereOrWithAStar) {
  EXPECT_TRUE(admits(AllowedHosts("0.0.0.0", {}), "any.example"));
  EXPECT_TRUE(admits(AllowedHosts("::", {"fleet.example"}), "any.example"));
  EXPECT_TRUE(admits(AllowedHosts("127.0.0.1", {"*"}), "any.example"));
}

TEST(AllowedHosts, AreNamesWithoutPort) {
  for (const char* good : {"*", "fleet.example", "10.0.0.1", "[::2]"}) {
    EXPECT_EQ(host_name_fault(good), std::nullopt) << good;
  }
  for (const char* bad : {"", "fleet.example:80", "fleet.example:", "http://fleet.example", "a b", "a/"}) {
    EXPECT_NE(host_name_fault(bad), std::nullopt) << bad;
  }
}

TEST(WrongHost, Is421OnEveryPath) {
  const TestServer server;
  for (const char* line : {"GET /", "GET /healthz", "GET /nowhere", "HEAD /metrics", "OPTIONS /v1/plan"}) {
    RawConnection raw(server.server.port());
    raw.send(std::string(line) + " HTTP/1.1\r\nHost: rebound.example\r\n\r\n");
    EXPECT_EQ(raw.receive_past("\r\n"), "HTTP/1.1 421 Misdirected Request\r\n") << line;
  }
  RawConnection absolute(server.server.port());
  absolute.send("GET http://rebound.example/ HTTP/1.1\r\nHost: localhost\r\n\r\n");
  EXPECT_NE(absolute.receive().find("wrong_host"), std::string::npos);
}

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
