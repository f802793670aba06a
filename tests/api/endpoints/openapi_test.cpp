#include "api/endpoints/openapi.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <set>
#include <string>
#include <string_view>

#include "api/response/error.h"
#include "tests/api/support/requests.h"

namespace fleetplan::api {
namespace {

using testing::IsEmpty;

Json document() { return Json::parse(openapi_document()); }

/// The problems of the document's responses, by the name of the example.
std::map<std::string, Json> documented_problems(const Json& openapi) {
  std::map<std::string, Json> problems;
  for (const auto& response : openapi["components"]["responses"]) {
    for (const auto& [name, example] : response["content"][kProblemJson]["examples"].items()) {
      EXPECT_TRUE(problems.emplace(name, example["value"]).second) << name << " is documented twice";
    }
  }
  return problems;
}

/// Every `"$ref"` below a value.
std::set<std::string> references(const Json& value) {
  std::set<std::string> found;
  for (const auto& [key, member] : value.items()) {
    if (key == "$ref") {
      found.insert(member.get<std::string>());
    } else if (member.is_structured()) {
      found.merge(references(member));
    }
  }
  return found;
}

TEST(OpenApi, IsOneCompleteDocumentOfThisVersion) {
  const Json openapi = document();
  EXPECT_EQ(openapi["openapi"], "3.1.0");
  EXPECT_EQ(openapi["info"]["version"], FLEETPLAN_VERSION);
  EXPECT_EQ(openapi_document().find("\"@"), std::string_view::npos) << "a part is not filled in";
  for (const std::string& reference : references(openapi)) {
    ASSERT_TRUE(reference.starts_with("#/")) << reference;
    EXPECT_TRUE(openapi.contains(Json::json_pointer(reference.substr(1)))) << reference;
  }
}

TEST(OpenApi, HasAnEntryForEachRowOfTheTableOfErrorsAndNoOthers) {
  std::map<std::string, ErrorCode> rows;
  for (const ErrorCode code : error_codes()) rows[std::string(name_of(code))] = code;
  auto missing = rows;
  for (const auto& [example, told] : documented_problems(document())) {
    const std::string name = told["code"];
    ASSERT_TRUE(rows.contains(name)) << example << " is not in the table";
    EXPECT_TRUE(example.starts_with(name)) << example;
    Json expected = json_of(problem_reply(rows[name], told["detail"], told["request_id"]));
    expected["errors"] = told["errors"];
    EXPECT_EQ(told, expected) << example;
    missing.erase(name);
  }
  EXPECT_THAT(missing, IsEmpty());
}

TEST(OpenApi, IsAnsweredAsJson) {
  const Reply reply = openapi_endpoint();
  EXPECT_EQ(reply.status, 200);
  EXPECT_EQ(reply.content_type, kJson);
  EXPECT_EQ(reply.body, openapi_document());
}

}  // namespace
}  // namespace fleetplan::api
