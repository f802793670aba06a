// What clients attach to requests, robots and goals.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "api/endpoints/endpoints.h"
#include "tests/api/support/answers.h"
#include "tests/api/support/fault_case.h"

namespace fleetplan::api {
namespace TEST_FILE {

/// Robot "a" visits two goals, the second one with metadata; "b" cannot reach its goal.
Json tagged_request() {
  Json request = swap_request();
  request["metadata"] = Json::parse(R"({"order": 18446744073709551615, "depth": -9007199254740993})");
  robot(request, 0).erase("goal");
  robot(request, 0)["goals"] = Json::parse(R"([{"x": 3.5, "y": 1.5}, {"x": 5.5, "y": 2.5}])");
  robot(request, 0)["goals"][1]["metadata"] = {{"task", "unload"}, {"lines", {1, 2.5, nullptr, true}}};
  robot(request, 0)["metadata"] = Json::object();
  robot(request, 1)["metadata"] = {{"name", "Bé \"2\""}};
  request["map"]["rows"] = {".........", "....#...#", "....#...#", "........."};
  robot(request, 1)["start"] = {{"x", 8.5}, {"y", 3.5}};
  robot(request, 1)["radius"] = 0.5;
  robot(request, 1)["goal"] = {{"x", 8.5}, {"y", 0.5}};
  robot(request, 1)["vicinity"] = 0.0;
  return request;
}

TEST(Metadata, IsRepeatedWhereItIs) {
  const Json request = tagged_request();
  const Json answer = plan_of(request);
  EXPECT_EQ(answer["metadata"], request["metadata"]);
  ASSERT_EQ(answer["plans"].size(), 2U);
  EXPECT_EQ(answer["plans"][0]["metadata"], Json::object());
  EXPECT_EQ(answer["plans"][1]["metadata"], request["robots"][1]["metadata"]);
  const Json& visits = answer["plans"][0]["visits"];
  EXPECT_FALSE(visits[0].contains("metadata"));
  EXPECT_EQ(visits[1]["metadata"], request["robots"][0]["goals"][1]["metadata"]);
}

TEST(Metadata, OfARobotWithoutAPlanIsRepeated) {
  Json request = tagged_request();
  request["options"] = {{"inflation", 0.4}};
  const Json answer = plan_of(request);
  ASSERT_FALSE(answer["unplanned"].empty());
  EXPECT_EQ(answer["unplanned"].back()["robot"], "b");
  EXPECT_EQ(answer["unplanned"].back()["metadata"], request["robots"][1]["metadata"]);
}

TEST(Metadata, ChangesNothingElse) {
  const Json with = plan_of(tagged_request());
  Json request = tagged_request();
  request.erase("metadata");
  for (Json& one : request["robots"]) one.erase("metadata");
  request["robots"][0]["goals"][1].erase("metadata");
  const Json without = plan_of(request);
  EXPECT_EQ(with["plans"][0]["actions"], without["plans"][0]["actions"]);
  EXPECT_FALSE(without.contains("metadata"));
  EXPECT_FALSE(without["plans"][0].contains("metadata"));
}

TEST(Metadata, OfAnAnswerMergedIntoItsRequestIsIgnored) {
  Json request = tagged_request();
  const Json answer = plan_of(request);
  for (const auto& member : answer.items()) request[member.key()] = member.value();
  const Reply reply = validate_endpoint(request.dump(), {});
  EXPECT_EQ(reply.status, 200) << reply.body;
  EXPECT_EQ(json_of(reply)["valid"], true);
}

TEST(Metadata, IsCarriedOverToTheNextMoment) {
  const Json request = tagged_request();
  const Json plans = plan_of(request)["plans"];
  const double arrives = plans[0]["visits"][0]["t_arrive"];
  const Json body = {{"request", request}, {"plans", plans}, {"at", arrives + 0.5}};
  const Reply reply = advance_endpoint(body.dump(), {});
  ASSERT_EQ(reply.status, 200) << reply.body;
  const Json next = json_of(reply);
  EXPECT_EQ(next["metadata"], request["metadata"]);
  EXPECT_EQ(next["robots"][1]["metadata"], request["robots"][1]["metadata"]);
  ASSERT_EQ(next["robots"][0]["goals"].size(), 1U);
  EXPECT_EQ(next["robots"][0]["goals"][0]["metadata"], request["robots"][0]["goals"][1]["metadata"]);
}

TEST(Metadata, OfOtherGoalsReplacesThatOfThoseLeft) {
  const Json request = tagged_request();
  Json body = {{"request", request}, {"plans", plan_of(request)["plans"]}, {"at", 1.0}};
  body["goals"] =
      Json::parse(R"([{"robot": "a", "goals": [{"x": 1.5, "y": 0.5, "metadata": {"task": 7}}]}])");
  const Reply reply = advance_endpoint(body.dump(), {});
  ASSERT_EQ(reply.status, 200) << reply.body;
  const Json goals = json_of(reply)["robots"][0]["goals"];
  ASSERT_EQ(goals.size(), 1U);
  EXPECT_EQ(goals[0]["metadata"], Json::parse(R"({"task": 7})"));
}

TEST(Metadata, OfTheWrongTypeOrSizeIsAFault) {
  const std::vector<FaultCase> cases{
      {"Text", [](Json& r) { r["metadata"] = "x"; }, "/metadata", "wrong_type", "must be an object"},
      {"List", [](Json& r) { robot(r, 0)["metadata"] = Json::array(); }, "/robots/0/metadata", "wrong_type",
       "must be an object"},
      {"OfAGoal", [](Json& r) { robot(r, 1)["goal"]["metadata"] = 1; }, "/robots/1/goal/metadata",
       "wrong_type", "must be an object"},
      {"TooLarge",
       [](Json& r) {
         robot(r, 0)["metadata"] = {{"text", std::string(17'000, 'x')}};
       },
       "/robots/0/metadata", "out_of_range", "at most 16384"}};
  for (const FaultCase& one : cases) expect_one_fault(swap_request(), one);
  std::string body = swap_request().dump();
  body.replace(body.rfind('}'), 1, R"(,"metadata":{"n":[1e999]}})");
  EXPECT_THAT(brief(faults_of(body)), testing::ElementsAre(testing::Pair("/metadata", "out_of_range")));
}

}  // namespace TEST_FILE
}  // namespace fleetplan::api
