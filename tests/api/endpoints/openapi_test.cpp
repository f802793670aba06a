#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <string>
#include <string_view>

#include "api/endpoints/endpoints.h"
#include "api/json/errors.h"
#include "api/openapi/generated_parts.h"
#include "tests/api/support/requests.h"

namespace fleetplan::api {
namespace TEST_FILE {

using testing::IsEmpty;

Json document() { return Json::parse(openapi_document()); }

/// The text of api/openapi.json.
std::string committed_document() {
  std::ifstream in(FLEETPLAN_OPENAPI);
  return {std::istreambuf_iterator<char>(in), {}};
}

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

TEST(OpenApi, HasTheCurrentVersionAndNoDanglingReference) {
  const Json openapi = document();
  EXPECT_EQ(openapi, Json::parse(committed_document()));
  EXPECT_EQ(openapi["openapi"], "3.1.0");
  EXPECT_EQ(openapi["info"]["version"], FLEETPLAN_VERSION);
  EXPECT_EQ(openapi["components"]["schemas"]["Health"]["properties"]["version"]["examples"],
            Json::array({FLEETPLAN_VERSION}));
  for (const std::string& reference : references(openapi)) {
    ASSERT_TRUE(reference.starts_with("#/")) << reference;
    EXPECT_TRUE(openapi.contains(Json::json_pointer(reference.substr(1)))) << reference;
  }
}

TEST(OpenApi, HasTheOptionsAndErrorsOfTheTables) {
  EXPECT_EQ(committed_document(), with_generated_parts(committed_document()))
      << "Build the target update_openapi to generate them again.";
}

TEST(OpenApi, HasTheScenariosAsExamples) {
  const Json openapi = document();
  const Json& content = openapi["paths"]["/v1/plan"]["post"]["requestBody"]["content"];
  const Json& documented = content["application/json"]["examples"];
  EXPECT_EQ(documented.size(), 3U);
  for (const auto& [name, example] : documented.items()) {
    const auto found = std::find_if(examples().begin(), examples().end(),
                                    [name = name](const Example& one) { return one.name == name; });
    ASSERT_NE(found, examples().end()) << name;
    EXPECT_EQ(example["value"], Json::parse(found->body)) << name;
  }
}

TEST(OpenApi, HasAnExampleOfEveryErrorInTheTable) {
  std::map<std::string, ErrorCode> rows;
  for (const ErrorRow& row : error_table()) rows[std::string(row.name)] = row.code;
  auto missing = rows;
  for (const auto& [example, problem] : documented_problems(document())) {
    const std::string name = problem["code"];
    ASSERT_TRUE(rows.contains(name)) << example << " is not in the table";
    EXPECT_TRUE(example.starts_with(name)) << example;
    Json expected = json_of(problem_reply(rows[name], problem["detail"], problem["request_id"]));
    expected["errors"] = problem["errors"];
    expected["errors_total"] = problem["errors"].size();
    EXPECT_EQ(problem, expected) << example;
    missing.erase(name);
  }
  EXPECT_THAT(missing, IsEmpty());
}

TEST(OpenApi, IsReturnedAsJson) {
  const Reply reply = openapi_endpoint();
  EXPECT_EQ(reply.status, 200);
  EXPECT_EQ(reply.content_type, kJson);
  EXPECT_EQ(reply.body, openapi_document());
}

}  // namespace TEST_FILE
}  // namespace fleetplan::api
