#include "api/response/error.h"

#include <gtest/gtest.h>

#include <set>
#include <tuple>

#include "tests/api/support/requests.h"

namespace fleetplan::api {
namespace TEST_FILE {

constexpr ErrorCode kLast = ErrorCode::draining;

TEST(Errors, HaveACompleteRowForEachCode) {
  std::set<std::string> names;
  for (int code = 0; code <= static_cast<int>(kLast); ++code) {
    const Json body = json_of(problem_reply(static_cast<ErrorCode>(code), "Because.", "id-1"));
    const std::string name(name_of(static_cast<ErrorCode>(code)));
    EXPECT_TRUE(names.insert(name).second) << name;
    EXPECT_EQ(body["type"], "urn:fleetplan:problem:" + name);
    EXPECT_EQ(body["code"], name);
    EXPECT_GT(body["title"].get<std::string>().size(), 5U);
    EXPECT_EQ(body["detail"], "Because.");
    EXPECT_EQ(body["request_id"], "id-1");
    EXPECT_EQ(body["errors"], Json::array());
  }
}

TEST(Errors, HaveTheDocumentedStatus) {
  const std::vector<std::tuple<ErrorCode, int, std::string>> rows{
      {ErrorCode::malformed_json, 400, "malformed_json"},
      {ErrorCode::too_deep, 400, "too_deep"},
      {ErrorCode::malformed_request, 400, "malformed_request"},
      {ErrorCode::unauthorized, 401, "unauthorized"},
      {ErrorCode::foreign_origin, 403, "foreign_origin"},
      {ErrorCode::not_found, 404, "not_found"},
      {ErrorCode::method_not_allowed, 405, "method_not_allowed"},
      {ErrorCode::not_acceptable, 406, "not_acceptable"},
      {ErrorCode::request_timeout, 408, "request_timeout"},
      {ErrorCode::body_too_large, 413, "body_too_large"},
      {ErrorCode::target_too_long, 414, "target_too_long"},
      {ErrorCode::unsupported_media_type, 415, "unsupported_media_type"},
      {ErrorCode::wrong_host, 421, "wrong_host"},
      {ErrorCode::invalid_request, 422, "invalid_request"},
      {ErrorCode::check_unfinished, 422, "check_unfinished"},
      {ErrorCode::memory_exceeded, 422, "memory_exceeded"},
      {ErrorCode::parse_unfinished, 422, "parse_unfinished"},
      {ErrorCode::head_too_large, 431, "head_too_large"},
      {ErrorCode::internal_error, 500, "internal_error"},
      {ErrorCode::overloaded, 503, "overloaded"},
      {ErrorCode::draining, 503, "draining"},
  };
  EXPECT_EQ(rows.size(), static_cast<std::size_t>(kLast) + 1);
  for (const auto& [code, status, name] : rows) {
    const Reply reply = problem_reply(code, "x", "y");
    EXPECT_EQ(status_of(code), status);
    EXPECT_EQ(reply.status, status);
    EXPECT_EQ(json_of(reply)["status"], status);
    EXPECT_EQ(name_of(code), name);
    EXPECT_EQ(reply.content_type, "application/problem+json");
  }
}

TEST(Errors, ListEveryFault) {
  const Json body = json_of(problem_reply(
      {ErrorCode::invalid_request, "Two.", {{"/a", "missing", "A \"quoted\" word."}, {"/b~1c", "x", "y"}}, 7},
      "i"));
  EXPECT_EQ(body["errors_total"], 7);
  EXPECT_EQ(body["errors"], Json::parse(R"([
    {"pointer": "/a", "code": "missing", "detail": "A \"quoted\" word."},
    {"pointer": "/b~1c", "code": "x", "detail": "y"}])"));
}

}  // namespace TEST_FILE
}  // namespace fleetplan::api
