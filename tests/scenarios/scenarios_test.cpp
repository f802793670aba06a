// Every ready request of GET /v1/examples is planned as its description promises.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "api/examples.h"
#include "api/plan_endpoint.h"
#include "api/validate_endpoint.h"

namespace fleetplan::api {
namespace {

using nlohmann::json;
using testing::IsEmpty;

/// Robot and reason of those that no plan can serve; the scenarios not listed are solved.
const std::map<std::string, json>& expected_unplanned() {
  static const std::map<std::string, json> expected = {
      {"partly-solvable",
       {{{"robot", "wide-lift"}, {"reason", "goal_unreachable"}, {"blocked_by", json::array()}},
        {{"robot", "late-comer"}, {"reason", "blocked_by_robots"}, {"blocked_by", {"charging"}}}}},
  };
  return expected;
}

/// With a budget that does not make the clock decide, however slow this build is.
json request_without_haste(const Example& example) {
  json request = json::parse(example.body);
  request["options"]["time_budget_ms"] = 120'000;
  return request;
}

class Scenario : public testing::TestWithParam<Example> {};

TEST_P(Scenario, IsPlannedAsPromisedAndValid) {
  const json request = request_without_haste(GetParam());
  const Reply reply = plan_endpoint(request.dump(), {.request_id = "scenario"});
  ASSERT_EQ(reply.status, 200) << reply.body;
  const json answer = json::parse(reply.body);

  const auto expected = expected_unplanned().find(std::string(GetParam().name));
  const bool partial = expected != expected_unplanned().end();
  EXPECT_EQ(answer.at("status"), partial ? "partial" : "solved");
  json unplanned = answer.at("unplanned");
  for (json& entry : unplanned) entry.erase("detail");
  EXPECT_EQ(unplanned, partial ? expected->second : json::array());
  EXPECT_EQ(answer.at("plans").size() + unplanned.size(), request.at("robots").size());
  EXPECT_EQ(answer.at("verified"), true);
  EXPECT_EQ(answer.at("deterministic"), true);
  EXPECT_THAT(answer.at("warnings"), IsEmpty());

  json check = request;
  check.update(answer);
  const Reply verdict = validate_endpoint(check.dump(), {.request_id = "scenario"});
  ASSERT_EQ(verdict.status, 200) << verdict.body;
  EXPECT_EQ(json::parse(verdict.body).at("valid"), true) << verdict.body;
}

INSTANTIATE_TEST_SUITE_P(Every, Scenario, testing::ValuesIn(examples().begin(), examples().end()),
                         [](const auto& scenario) {
                           std::string name(scenario.param.name);
                           for (char& c : name) c = c == '-' ? '_' : c;
                           return name;
                         });

TEST(Scenarios, AreTheFilesOfTheFolderAndTheEntriesOfItsIndex) {
  std::set<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(FLEETPLAN_SCENARIOS)) {
    const auto& path = entry.path();
    if (path.extension() == ".json" && path.filename() != "index.json") files.insert(path.stem().string());
  }
  std::set<std::string> embedded;
  for (const Example& example : examples()) embedded.emplace(example.name);
  std::vector<std::string> listed;
  const json list = json::parse(examples_endpoint().body);
  for (const json& entry : list.at("examples")) listed.push_back(entry.at("name"));

  EXPECT_EQ(embedded, files);
  EXPECT_THAT(listed, testing::UnorderedElementsAreArray(files));
  ASSERT_FALSE(listed.empty());
  EXPECT_EQ(listed.front(), "corridor-swap") << "the first that a visitor sees";
}

}  // namespace
}  // namespace fleetplan::api
