// Every example of GET /v1/examples is planned as its description says.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <ostream>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "api/endpoints/endpoints.h"

namespace fleetplan::api {

/// GoogleTest prints scenarios with this function; it has to be in the namespace of Example.
void PrintTo(const Example& example, std::ostream* out) { *out << example.name; }

namespace TEST_FILE {

using nlohmann::json;
using testing::IsEmpty;
using testing::IsSupersetOf;

struct ExpectedUnplanned {
  std::string robot;
  std::string reason;
  std::set<std::string> blocked_by;  // at least these
};

/// The robots of a scenario that cannot be planned. All other scenarios are solved.
std::vector<ExpectedUnplanned> expected_unplanned(std::string_view scenario) {
  if (scenario == "partly-solvable") {
    return {{"wide-lift", "goal_unreachable", {}}, {"late-comer", "blocked_by_robots", {"charging"}}};
  }
  return {};
}

/// The request of an example with a budget so long that the clock does not influence the plan, even in a slow
/// build.
json request_with_long_budget(const Example& example) {
  json request = json::parse(example.body);
  request["options"]["time_budget_ms"] = 120'000;
  return request;
}

class Scenario : public testing::TestWithParam<Example> {};

TEST_P(Scenario, IsPlannedAsDescribedAndValid) {
  const json request = request_with_long_budget(GetParam());
  const Reply reply = plan_endpoint(request.dump(), RequestContext{});
  ASSERT_EQ(reply.status, 200) << reply.body;
  const json answer = json::parse(reply.body);

  const std::vector<ExpectedUnplanned> expected = expected_unplanned(GetParam().name);
  EXPECT_EQ(answer.at("status"), expected.empty() ? "solved" : "partial");
  EXPECT_EQ(answer.at("plans").size() + expected.size(), request.at("robots").size());
  ASSERT_EQ(answer.at("unplanned").size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const json& entry = answer.at("unplanned").at(i);
    EXPECT_EQ(entry.at("robot"), expected[i].robot);
    EXPECT_EQ(entry.at("reason"), expected[i].reason);
    const auto blocked_by = entry.at("blocked_by").get<std::set<std::string>>();
    EXPECT_THAT(blocked_by, IsSupersetOf(expected[i].blocked_by)) << entry;
  }
  EXPECT_EQ(answer.at("verified"), true);
  EXPECT_EQ(answer.at("deterministic"), true);
  EXPECT_THAT(answer.at("warnings"), IsEmpty());

  json check = request;
  check.update(answer);
  const Reply verdict = validate_endpoint(check.dump(), RequestContext{});
  ASSERT_EQ(verdict.status, 200) << verdict.body;
  EXPECT_EQ(json::parse(verdict.body).at("valid"), true) << verdict.body;
}

INSTANTIATE_TEST_SUITE_P(Every, Scenario, testing::ValuesIn(examples().begin(), examples().end()),
                         [](const auto& scenario) {
                           std::string name(scenario.param.name);
                           for (char& c : name) c = c == '-' ? '_' : c;
                           return name;
                         });

/// A request with its answer in which these robots have their previous plans again.
json with_previous_plans(const json& request, const json& answer, const std::set<std::string>& robots) {
  json both = request;
  both.update(answer);
  for (json& plan : both.at("plans")) {
    if (!robots.contains(plan.at("robot"))) continue;
    for (const json& robot : request.at("robots")) {
      if (robot.at("id") == plan.at("robot")) plan.at("actions") = robot.at("previous");
    }
  }
  return both;
}

json request_named(std::string_view name) {
  const auto all = examples();
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const Example& example) { return example.name == name; });
  EXPECT_NE(found, all.end()) << name;
  return found == all.end() ? json() : request_with_long_budget(*found);
}

TEST(Scenarios, ARobotThatCannotPassAnotherOneIsStuckWithAHorizonOnceItIsThere) {
  json request = request_named("partly-solvable");
  request["options"]["horizon"] = 10.0;
  const auto plan_of_late_comer = [&] {
    json answer = json::parse(plan_endpoint(request.dump(), RequestContext{}).body);
    const json plans = answer.at("plans");
    const auto found = std::find_if(plans.begin(), plans.end(),
                                    [](const json& plan) { return plan.at("robot") == "late-comer"; });
    return std::pair{answer, *found};
  };
  const auto [first, comes_near] = plan_of_late_comer();
  EXPECT_FALSE(comes_near.contains("stuck")) << comes_near;
  const json advance{{"request", request}, {"plans", first.at("plans")}, {"at", 10.0}};
  request = json::parse(advance_endpoint(advance.dump(), RequestContext{}).body);
  const auto [second, stuck] = plan_of_late_comer();
  EXPECT_EQ(stuck.at("stuck"), true) << stuck;
  EXPECT_EQ(stuck.at("blocked_by"), json::array({"charging"}));
  EXPECT_EQ(stuck.at("estimated_cost"), nullptr);
  EXPECT_EQ(second.at("warnings").size(), 1U) << second.at("warnings");
}

TEST(Scenarios, ALatePalletChangesOnlyThePlansThatMust) {
  const json request = request_named("late-pallet");
  const json answer = json::parse(plan_endpoint(request.dump(), RequestContext{}).body);
  ASSERT_EQ(answer.at("plans").size(), request.at("robots").size());
  std::set<std::string> changed;
  for (std::size_t i = 0; i < answer.at("plans").size(); ++i) {
    const json& plan = answer.at("plans").at(i);
    const json& robot = request.at("robots").at(i);
    ASSERT_EQ(plan.at("robot"), robot.at("id"));
    if (plan.at("actions") != robot.at("previous")) changed.insert(plan.at("robot").get<std::string>());
  }
  EXPECT_FALSE(changed.empty());
  EXPECT_LE(changed.size(), 3u) << "of 40 robots";
  for (const std::string& robot : changed) {
    const json back = with_previous_plans(request, answer, {robot});
    const Reply verdict = validate_endpoint(back.dump(), RequestContext{});
    ASSERT_EQ(verdict.status, 200) << verdict.body;
    EXPECT_EQ(json::parse(verdict.body).at("valid"), false) << robot << " could have kept its plan";
  }
}

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
  EXPECT_EQ(listed.front(), "corridor-swap") << "the page opens with it";
}

}  // namespace TEST_FILE
}  // namespace fleetplan::api
