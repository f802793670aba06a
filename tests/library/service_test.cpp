#include <fleetplan/service.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cstddef>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>
#include <stop_token>
#include <string>
#include <string_view>

#include "api/endpoints/endpoints.h"
#include "api/request/limits.h"

namespace fleetplan {
namespace TEST_FILE {

using Json = nlohmann::ordered_json;
using std::chrono::steady_clock;
using testing::HasSubstr;

using EndpointFunction = api::Reply (*)(std::string_view, const api::RequestContext&);

struct Pair {
  Endpoint of_library;
  EndpointFunction of_service;
};

/// The endpoints by their paths.
const std::map<std::string, Pair>& endpoints() {
  static const std::map<std::string, Pair> all{
      {"/v1/plan", {Endpoint::plan, api::plan_endpoint}},
      {"/v1/validate", {Endpoint::validate, api::validate_endpoint}},
      {"/v1/dependencies", {Endpoint::dependencies, api::dependencies_endpoint}},
      {"/v1/advance", {Endpoint::advance, api::advance_endpoint}},
      {"/v1/simulate", {Endpoint::simulate, api::simulate_endpoint}},
      {"/v1/margins", {Endpoint::margins, api::margins_endpoint}},
      {"/v1/retime", {Endpoint::retime, api::retime_endpoint}},
      {"/v1/matrix", {Endpoint::matrix, api::matrix_endpoint}},
      {"/v1/assign", {Endpoint::assign, api::assign_endpoint}},
      {"/v1/export/vda5050", {Endpoint::export_vda5050, api::vda5050_endpoint}},
      {"/v1/import/vda5050", {Endpoint::import_vda5050, api::import_vda5050_endpoint}},
  };
  return all;
}

/// An answer without what differs from call to call.
Json comparable(const std::string& body) {
  Json answer = Json::parse(body);
  answer.erase("timings_ms");
  if (answer.contains("plan") && answer["plan"].is_object()) answer["plan"].erase("timings_ms");
  return answer;
}

/// Sends a body to the library and to the service, and returns the answer. Both must give the same answer.
Json same_answer(const std::string& path, const std::string& body, int status = 200) {
  const Pair& pair = endpoints().at(path);
  api::RequestContext context;
  context.request_id = "test-1";
  const api::Reply expected = pair.of_service(body, context);
  const Answer found = answer(pair.of_library, body, {}, {.request_id = "test-1"});
  EXPECT_EQ(found.status, status) << path << ' ' << found.body;
  EXPECT_EQ(found.status, expected.status) << path;
  EXPECT_EQ(found.ok(), status == 200) << path;
  EXPECT_EQ(comparable(found.body), comparable(expected.body)) << path;
  return Json::parse(found.body);
}

TEST(PublicService, AnswersTheExamplesOfEveryEndpointAsTheService) {
  const Json openapi = Json::parse(api::openapi_document());
  std::set<std::string> asked;
  for (const auto& [path, methods] : openapi["paths"].items()) {
    if (!methods.contains("post")) continue;
    const Json& content = methods["post"]["requestBody"]["content"]["application/json"];
    for (const auto& [name, example] : content["examples"].items()) {
      SCOPED_TRACE(path + " " + name);
      same_answer(path, example["value"].dump());
      asked.insert(path);
    }
  }
  EXPECT_EQ(asked.size(), endpoints().size()) << "a path has no example, or the library lacks its endpoint";
}

/// A request that the clock does not end.
Json first_plan_only(std::string_view body) {
  Json request = Json::parse(body);
  request["options"]["mode"] = "first";
  request["options"]["time_budget_ms"] = 60'000;
  return request;
}

TEST(PublicService, AnswersTheScenariosAndWhatFollowsAsTheService) {
  for (const api::Example& scenario : api::examples()) {
    SCOPED_TRACE(scenario.name);
    if (scenario.name == "hospital-wing" || scenario.name == "office-floor") continue;  // seconds each
    const Json request = first_plan_only(scenario.body);
    const Json plan = same_answer("/v1/plan", request.dump());
    Json with_plans = request;
    with_plans["plans"] = plan["plans"];
    EXPECT_TRUE(same_answer("/v1/validate", with_plans.dump())["valid"]);
    same_answer("/v1/dependencies", with_plans.dump());
    with_plans["policy"] = "absorb_waits";
    with_plans["runs"] = 2;
    same_answer("/v1/simulate", with_plans.dump());
    const Json moment{{"request", request}, {"plans", plan["plans"]}, {"at", 4.0}, {"commit", 1.0}};
    const Json next = same_answer("/v1/advance", moment.dump());
    same_answer("/v1/plan", next.dump());
  }
}

TEST(PublicService, TellsWhereABodyIsWrong) {
  const Json unreadable = same_answer("/v1/plan", "{\"map\": {\"rows\": [NaN]}}", 400);
  EXPECT_EQ(unreadable["code"], "malformed_json");
  EXPECT_THAT(unreadable["detail"].get<std::string>(), HasSubstr("line 1, column 19"));
  EXPECT_EQ(unreadable["request_id"], "test-1");
  const Json invalid =
      same_answer("/v1/plan", R"({"map": {"rows": [".."]}, "robots": [{"id": "a", "radius": -1}]})", 422);
  EXPECT_EQ(invalid["code"], "invalid_request");
  EXPECT_THAT(invalid["errors"].dump(), HasSubstr("/robots/0/radius"));
  for (const auto& [path, pair] : endpoints()) {
    same_answer(path, "", 400);
    same_answer(path, "[]", 422);
    same_answer(path, R"({"unknown": 1})", 422);
  }
}

const std::string kSwap = R"({
  "map": {"rows": ["####.####", "........."]},
  "robots": [
    {"id": "a", "radius": 0.3, "linear_speed": 1, "angular_speed": 3,
     "start": {"x": 0.5, "y": 0.5}, "goal": {"x": 8.5, "y": 0.5}},
    {"id": "b", "radius": 0.3, "linear_speed": 1, "angular_speed": 3,
     "start": {"x": 8.5, "y": 0.5}, "goal": {"x": 0.5, "y": 0.5}}]})";

std::string swap_with(const Json& options) {
  Json request = Json::parse(kSwap);
  request["options"] = options;
  return request.dump();
}

TEST(PublicService, HasTheRequestIdOfTheProgramOrNone) {
  EXPECT_EQ(Json::parse(answer(Endpoint::plan, kSwap).body)["request_id"], "");
  const Answer named = answer(Endpoint::plan, kSwap, {}, {.request_id = "shift-7"});
  EXPECT_EQ(Json::parse(named.body)["request_id"], "shift-7");
}

TEST(PublicService, HasTheLimitsOfTheService) {
  const ServiceLimits ours;
  const api::Limits theirs;
  EXPECT_EQ(ours.default_budget.count(), theirs.default_budget_ms);
  EXPECT_EQ(ours.max_budget.count(), theirs.max_budget_ms);
  EXPECT_EQ(ours.max_body, theirs.max_body);
  EXPECT_EQ(ours.max_cells, theirs.max_cells);
  EXPECT_EQ(ours.max_robots, theirs.max_robots);
  EXPECT_EQ(ours.max_goals, theirs.max_goals);
  EXPECT_EQ(ours.max_actions, theirs.max_actions);
  EXPECT_EQ(ours.max_obstacles, theirs.max_obstacles);
  EXPECT_EQ(ours.max_obstacle_entries, theirs.max_obstacle_entries);
  EXPECT_EQ(ours.max_zones, theirs.max_zones);
  EXPECT_EQ(ours.max_zone_corners, theirs.max_zone_corners);
  EXPECT_EQ(ours.max_plan_memory, theirs.max_plan_memory);
}

TEST(PublicService, HeedsTheLimitsOfTheProgram) {
  const Answer crowded = answer(Endpoint::plan, kSwap, {}, {.limits = {.max_robots = 1}});
  EXPECT_EQ(crowded.status, 422);
  EXPECT_THAT(crowded.body, HasSubstr("/robots"));
  const Answer wide = answer(Endpoint::plan, kSwap, {}, {.limits = {.max_cells = 17}});
  EXPECT_EQ(wide.status, 422);
  EXPECT_THAT(wide.body, HasSubstr("/map"));
  const Answer long_one = answer(Endpoint::plan, kSwap, {}, {.limits = {.max_body = 100}});
  EXPECT_EQ(long_one.status, 413);
  EXPECT_EQ(Json::parse(long_one.body)["code"], "body_too_large");
  EXPECT_TRUE(answer(Endpoint::plan, kSwap, {}, {.limits = {.max_body = kSwap.size()}}).ok());
}

TEST(PublicService, ClampsBudgetsAndHasADefault) {
  using std::chrono::milliseconds;
  const ServiceOptions hasty{
      .limits = {.default_budget = milliseconds(200), .max_budget = milliseconds(300)}};
  const auto seconds_of = [&](const Json& options, std::string& warnings) {
    const auto begin = steady_clock::now();
    const Answer found = answer(Endpoint::plan, swap_with(options), {}, hasty);
    EXPECT_TRUE(found.ok()) << found.body;
    warnings = Json::parse(found.body)["warnings"].dump();
    return std::chrono::duration<double>(steady_clock::now() - begin).count();
  };
  std::string warnings;
  EXPECT_LT(seconds_of({{"mode", "anytime"}}, warnings), 5.0);
  EXPECT_EQ(warnings, "[]");
  EXPECT_LT(seconds_of({{"mode", "anytime"}, {"time_budget_ms", 90'000}}, warnings), 5.0);
  EXPECT_THAT(warnings, HasSubstr("clamped from 90000 to 300"));
}

TEST(PublicService, RefusesLimitsOutOfRangeAndUnknownEndpoints) {
  using std::chrono::milliseconds;
  const auto with = [](const ServiceLimits& limits) {
    return answer(Endpoint::plan, kSwap, {}, {.limits = limits});
  };
  EXPECT_THROW(with({.default_budget = milliseconds(0)}), std::invalid_argument);
  EXPECT_THROW(with({.max_budget = milliseconds(4999)}), std::invalid_argument);
  EXPECT_THROW(with({.max_budget = std::chrono::hours(25)}), std::invalid_argument);
  EXPECT_THROW(with({.max_cells = 0}), std::invalid_argument);
  EXPECT_THROW(with({.max_cells = 2'000'000'000}), std::invalid_argument);
  EXPECT_THROW(answer(static_cast<Endpoint>(11), kSwap), std::invalid_argument);
}

/// Many robots that are improved for a minute, unless something ends that.
std::string long_request() {
  for (const api::Example& scenario : api::examples()) {
    if (scenario.name != "hall-100") continue;
    Json request = Json::parse(scenario.body);
    request["options"]["mode"] = "anytime";
    request["options"]["time_budget_ms"] = 60'000;
    return request.dump();
  }
  return "";
}

TEST(PublicService, EndsSoonAfterAStopWithThePlanThatItHas) {
  std::stop_source stop;
  steady_clock::time_point requested;
  const auto stop_with_a_plan = [&](const Progress& progress) {
    if (!progress.best || stop.stop_requested()) return;
    requested = steady_clock::now();
    stop.request_stop();
  };
  const Answer found = answer(Endpoint::plan, long_request(), {stop.get_token(), stop_with_a_plan});
  ASSERT_TRUE(stop.stop_requested());
  EXPECT_LT(steady_clock::now() - requested, std::chrono::seconds(5));
  ASSERT_TRUE(found.ok()) << found.body;
  const Json plan = Json::parse(found.body);
  EXPECT_EQ(plan["status"], "solved");
  EXPECT_EQ(plan["verified"], true);
  EXPECT_EQ(plan["deterministic"], false);
}

/// Answers that take next to no time are given in spite of a stop.
TEST(PublicService, AnswersNothingThatTakesTimeAfterAStop) {
  const std::set<std::string> short_ones{"/v1/advance", "/v1/retime", "/v1/export/vda5050",
                                         "/v1/import/vda5050"};
  std::stop_source stop;
  stop.request_stop();
  const Json openapi = Json::parse(api::openapi_document());
  for (const auto& [path, pair] : endpoints()) {
    const Json& content = openapi["paths"][path]["post"]["requestBody"]["content"]["application/json"];
    const Answer found =
        answer(pair.of_library, content["examples"].front()["value"].dump(), {stop.get_token()});
    if (found.ok() && short_ones.contains(path)) continue;
    EXPECT_EQ(found.status, 503) << path << ' ' << found.body;
    EXPECT_EQ(Json::parse(found.body)["code"], "draining") << path;
  }
}

TEST(PublicService, TellsTheProgressWithoutChangingThePlan) {
  std::size_t planned = 0;
  Control control;
  control.progress = [&](const Progress& progress) { planned = progress.planned; };
  const Json with = comparable(answer(Endpoint::plan, kSwap, control).body);
  EXPECT_EQ(planned, 2U);
  EXPECT_EQ(with, comparable(answer(Endpoint::plan, kSwap).body));
  control.progress = [](const Progress&) { throw std::runtime_error("enough"); };
  EXPECT_THROW(answer(Endpoint::plan, kSwap, control), std::runtime_error);
  EXPECT_TRUE(answer(Endpoint::matrix, R"({
    "map": {"rows": ["..."]}, "robot": {"radius": 0.3, "linear_speed": 1, "angular_speed": 3},
    "from": [{"x": 0.5, "y": 0.5}], "to": [{"x": 2.5, "y": 0.5}]})",
                     control)
                  .ok());
}

}  // namespace TEST_FILE
}  // namespace fleetplan
