// What the server answers, over a real socket, with a stub in place of the planner.

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>

#include "server/ops/process.h"
#include "tests/server/support/test_server.h"

namespace fleetplan::server {
namespace TEST_FILE {

constexpr const char* kJsonType = "application/json";

class HttpAnswers : public testing::Test {
 protected:
  static Settings settings() {
    Settings settings;
    settings.limits.max_body = 1 << 20;
    return settings;
  }

  /// Checks that an answer is a problem of this status and code, with the same id as the header.
  static nlohmann::json expect_problem(const httplib::Result& result, int status, const std::string& code) {
    EXPECT_TRUE(result) << httplib::to_string(result.error());
    if (!result) return {};
    EXPECT_EQ(result->status, status);
    EXPECT_EQ(result->get_header_value("Content-Type"), "application/problem+json");
    const auto problem = nlohmann::json::parse(result->body, nullptr, false);
    EXPECT_TRUE(problem.is_object()) << result->body;
    if (!problem.is_object()) return {};
    EXPECT_EQ(problem.value("status", 0), status);
    EXPECT_EQ(problem.value("code", ""), code);
    EXPECT_EQ(problem.value("request_id", ""), result->get_header_value("X-Request-Id"));
    return problem;
  }

  /// The server still answers, on this connection or a new one.
  void expect_served() {
    const auto result = client.Post("/v1/plan", "abc", kJsonType);
    ASSERT_TRUE(result) << httplib::to_string(result.error());
    EXPECT_EQ(result->status, 200);
    EXPECT_EQ(result->body, R"({"size":3})");
  }

  TestServer server{settings()};
  httplib::Client client = server.client();
};

TEST_F(HttpAnswers, PlanAndValidatePassTheBodyToTheService) {
  for (const char* path : {"/v1/plan", "/v1/validate"}) {
    const auto result = client.Post(path, "12345", kJsonType);
    ASSERT_TRUE(result);
    EXPECT_EQ(result->status, 200);
    EXPECT_EQ(result->get_header_value("Content-Type"), kJsonType);
    EXPECT_EQ(result->body, R"({"size":5})");
  }
}

TEST_F(HttpAnswers, HealthReadinessLimitsAndExamplesAreJson) {
  const auto health = client.Get("/healthz?verbose");
  ASSERT_TRUE(health);
  EXPECT_EQ(nlohmann::json::parse(health->body), (nlohmann::json{{"status", "ok"}, {"version", kVersion}}));
  const auto ready = client.Get("/readyz");
  ASSERT_TRUE(ready);
  EXPECT_EQ(ready->status, 200);
  const auto limits = client.Get("/v1/limits");
  ASSERT_TRUE(limits);
  EXPECT_EQ(nlohmann::json::parse(limits->body)["max_body"], 1 << 20);
  const auto list = client.Get("/v1/examples");
  ASSERT_TRUE(list);
  EXPECT_EQ(list->body, R"({"examples":["tiny"]})");
  const auto example = client.Get("/v1/examples/tiny");
  ASSERT_TRUE(example);
  EXPECT_EQ(example->body, R"({"robots":[]})");
}

TEST_F(HttpAnswers, HeadHasTheFieldsOfGetAndNoBody) {
  for (const char* path : {"/healthz", "/v1/limits", "/v1/openapi.json", "/v1/examples/tiny", "/readyz"}) {
    const httplib::Headers plain{{"Accept-Encoding", "identity"}};
    const auto get = client.Get(path, plain);
    const auto head = client.Head(path, plain);
    ASSERT_TRUE(get && head) << path;
    EXPECT_EQ(head->status, 200);
    EXPECT_EQ(head->get_header_value("Content-Length"), std::to_string(get->body.size()));
    EXPECT_EQ(head->get_header_value("Content-Type"), get->get_header_value("Content-Type"));
    EXPECT_TRUE(head->body.empty());
  }
  const auto missing = client.Head("/nowhere");
  ASSERT_TRUE(missing);
  EXPECT_EQ(missing->status, 404);
  expect_served();
}

TEST_F(HttpAnswers, AnUnknownPathIs404) {
  expect_problem(client.Get("/v2/plan"), 404, "not_found");
  expect_problem(client.Post("/v1/plan/", "{}", kJsonType), 404, "not_found");
  expect_problem(client.Get("/%ff%fe"), 404, "not_found");
  expect_problem(client.Get("/"), 404, "not_found");  // no web root here
  expect_served();
}

TEST_F(HttpAnswers, AnUnknownExampleIs404AndListsTheExamples) {
  const auto problem = expect_problem(client.Get("/v1/examples/huge"), 404, "not_found");
  EXPECT_NE(problem.value("detail", "").find("tiny, narrow-door"), std::string::npos);
}

TEST_F(HttpAnswers, AWrongMethodIs405WithAllow) {
  const auto expect_405 = [](const httplib::Result& result, const std::string& allow) {
    expect_problem(result, 405, "method_not_allowed");
    ASSERT_TRUE(result);
    EXPECT_EQ(result->get_header_value("Allow"), allow);
  };
  expect_405(client.Get("/v1/plan"), "POST");
  expect_405(client.Put("/v1/plan", "{}", kJsonType), "POST");
  expect_405(client.Patch("/v1/validate", "{}", kJsonType), "POST");
  expect_405(client.Options("/v1/plan"), "POST");
  expect_405(client.Delete("/healthz"), "GET, HEAD");
  expect_405(client.Post("/v1/examples", "{}", kJsonType), "GET, HEAD");
  expect_405(client.Post("/", "{}", kJsonType), "GET, HEAD");
  expect_served();
}

TEST_F(HttpAnswers, AnAcceptFieldThatExcludesJsonAndEventsIs406) {
  const auto post = [&](const char* accept) {
    return client.Post("/v1/plan", httplib::Headers{{"Accept", accept}}, "abc", kJsonType);
  };
  expect_problem(post("text/html"), 406, "not_acceptable");
  expect_problem(post("application/json;q=0, text/event-stream;q=0, */*"), 406, "not_acceptable");
  const auto accepted = post("text/html;q=0.9, */*;q=0.1");
  ASSERT_TRUE(accepted);
  EXPECT_EQ(accepted->status, 200);
  const auto elsewhere = client.Get("/healthz", httplib::Headers{{"Accept", "text/html"}});
  ASSERT_TRUE(elsewhere);
  EXPECT_EQ(elsewhere->status, 200);
}

TEST_F(HttpAnswers, AnotherContentTypeIs415WithARemedy) {
  const auto problem = expect_problem(client.Post("/v1/plan", "abc", "application/x-www-form-urlencoded"),
                                      415, "unsupported_media_type");
  EXPECT_NE(problem.value("detail", "").find("--json"), std::string::npos);
  expect_problem(client.Post("/v1/validate", "abc", "text/plain"), 415, "unsupported_media_type");
  const auto accepted = client.Post("/v1/plan", "abc", "application/json; charset=utf-8");
  ASSERT_TRUE(accepted);
  EXPECT_EQ(accepted->status, 200);
  expect_served();
}

TEST_F(HttpAnswers, AnotherContentEncodingIs415) {
  expect_problem(client.Post("/v1/plan", httplib::Headers{{"Content-Encoding", "br"}}, "abc", kJsonType), 415,
                 "unsupported_media_type");
}

TEST_F(HttpAnswers, ABodyOverTheLimitIs413WithItsSizeAndTheLimit) {
  const auto result = client.Post("/v1/plan", std::string((1 << 20) + 1, ' '), kJsonType);
  const auto problem = expect_problem(result, 413, "body_too_large");
  EXPECT_NE(problem.value("detail", "").find("1048577"), std::string::npos);
  EXPECT_NE(problem.value("detail", "").find("1048576"), std::string::npos);
  EXPECT_NE(problem.value("detail", "").find("as a PNG"), std::string::npos);
  expect_served();
}

TEST_F(HttpAnswers, AHugeBodyIs413EvenIfTheClientSendsAllOfItFirst) {
  expect_problem(client.Post("/v1/plan", std::string(16 << 20, ' '), kJsonType), 413, "body_too_large");
  expect_served();
}

TEST_F(HttpAnswers, ABodyAtTheLimitIsServed) {
  const auto result = client.Post("/v1/plan", std::string(1 << 20, ' '), kJsonType);
  ASSERT_TRUE(result);
  EXPECT_EQ(result->body, R"({"size":1048576})");
}

TEST_F(HttpAnswers, AGzipBodyIsDecompressed) {
  client.set_compress(true);
  const auto result = client.Post("/v1/plan", std::string(300'000, ' '), kJsonType);
  ASSERT_TRUE(result);
  EXPECT_EQ(result->body, R"({"size":300000})");
}

TEST_F(HttpAnswers, AGzipBombIs413) {
  client.set_compress(true);
  const auto problem =
      expect_problem(client.Post("/v1/plan", std::string(64 << 20, ' '), kJsonType), 413, "body_too_large");
  EXPECT_NE(problem.value("detail", "").find("1048576"), std::string::npos);
  client.set_compress(false);
  expect_served();
}

TEST_F(HttpAnswers, ABodyThatIsNotGzipAsDeclaredIs400) {
  expect_problem(
      client.Post("/v1/plan", httplib::Headers{{"Content-Encoding", "gzip"}}, "plain text", kJsonType), 400,
      "malformed_request");
  expect_served();
}

TEST_F(HttpAnswers, AnExceptionIs500WithoutItsText) {
  const auto result = client.Post("/v1/plan", "throw", kJsonType);
  expect_problem(result, 500, "internal_error");
  ASSERT_TRUE(result);
  EXPECT_EQ(result->body.find("secret"), std::string::npos);
  for (const auto& [name, value] : result->headers)
    EXPECT_EQ(value.find("secret"), std::string::npos) << name;
  expect_served();
}

TEST_F(HttpAnswers, ALackOfMemoryIs503WithRetryAfter) {
  const auto result = client.Post("/v1/plan", "no memory", kJsonType);
  expect_problem(result, 503, "overloaded");
  ASSERT_TRUE(result);
  EXPECT_TRUE(result->has_header("Retry-After"));
  expect_served();
}

TEST_F(HttpAnswers, ARangeIsIgnored) {
  for (const char* range : {"bytes=0-1", "nonsense"}) {
    const httplib::Headers headers{{"Range", range}};
    const auto post = client.Post("/v1/plan", headers, "abc", kJsonType);
    ASSERT_TRUE(post);
    EXPECT_EQ(post->status, 200);
    EXPECT_EQ(post->body, R"({"size":3})");
    const auto get = client.Get("/v1/examples/tiny", headers);
    ASSERT_TRUE(get);
    EXPECT_EQ(get->status, 200);
    EXPECT_EQ(get->body, R"({"robots":[]})");
  }
}

TEST_F(HttpAnswers, AWellFormedRequestIdIsKept) {
  const auto result = client.Get("/healthz", httplib::Headers{{"X-Request-Id", "a.B_c-9"}});
  ASSERT_TRUE(result);
  EXPECT_EQ(result->get_header_value("X-Request-Id"), "a.B_c-9");
  const auto refused = client.Get("/nowhere", httplib::Headers{{"X-Request-Id", "a.B_c-9"}});
  ASSERT_TRUE(refused);
  EXPECT_EQ(refused->get_header_value("X-Request-Id"), "a.B_c-9");
}

TEST_F(HttpAnswers, AnIllFormedOrMissingRequestIdIsReplaced) {
  std::set<std::string> made;
  for (const std::string& sent :
       {std::string("a b"), std::string("{}"), std::string(129, 'a'), std::string()}) {
    const auto headers = sent.empty() ? httplib::Headers{} : httplib::Headers{{"X-Request-Id", sent}};
    const auto result = client.Get("/healthz", headers);
    ASSERT_TRUE(result);
    const auto id = result->get_header_value("X-Request-Id");
    EXPECT_EQ(id.size(), 32u) << id;
    EXPECT_EQ(id.find_first_not_of("0123456789abcdef"), std::string::npos) << id;
    made.insert(id);
  }
  EXPECT_EQ(made.size(), 4u);
}

TEST_F(HttpAnswers, AreCompressedByGzipAndNeverByBrotli) {
  client.set_decompress(false);
  const auto encoding = [&](const char* accept) {
    const auto result =
        client.Post("/v1/plan", httplib::Headers{{"Accept-Encoding", accept}}, "large", kJsonType);
    EXPECT_TRUE(result);
    return result ? result->get_header_value("Content-Encoding") : "no answer";
  };
  EXPECT_EQ(encoding("gzip"), "gzip");
  EXPECT_EQ(encoding("br, gzip, deflate"), "gzip");
  EXPECT_EQ(encoding("br"), "");
  EXPECT_EQ(encoding("gzip;q=0"), "");
}

TEST_F(HttpAnswers, SeveralShareOneConnection) {
  for (int i = 0; i < 20; ++i) expect_served();
}

}  // namespace TEST_FILE
}  // namespace fleetplan::server
