#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "api/endpoints/endpoints.h"
#include "tests/api/support/requests.h"

namespace fleetplan::api {
namespace TEST_FILE {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Pair;

RequestContext context() {
  RequestContext context;
  context.request_id = "test";
  return context;
}

/// Two robots at the left end of a hall, the second one with a goal, and two tasks.
Json two_tasks() {
  return Json::parse(R"({
    "request": {
      "map": {"rows": ["............", "............", "............"]},
      "robot_defaults": {"radius": 0.4, "linear_speed": 1.0, "angular_speed": 3.0},
      "robots": [
        {"id": "a", "start": {"x": 0.5, "y": 0.5}},
        {"id": "b", "start": {"x": 0.5, "y": 2.5}, "goal": {"x": 3.5, "y": 2.5, "service": 2}}],
      "metadata": {"shift": 3}},
    "tasks": [
      {"id": "near", "goals": [{"x": 6.5, "y": 1.5}]},
      {"id": "far", "goals": [{"x": 4.5, "y": 0.5, "service": 1, "metadata": {"load": "x"}}, {"x": 11.5, "y": 0.5}]}
    ]})");
}

Reply reply_to(const Json& request) { return assign_endpoint(request.dump(), context()); }

Json answer_to(const Json& request) {
  const Reply reply = reply_to(request);
  EXPECT_EQ(reply.status, 200) << reply.body;
  return json_of(reply);
}

Faults faults(const Json& request) { return faults_in(reply_to(request)); }

/// Who has which task.
Faults pairs(const Json& answer) {
  Faults pairs;
  for (const Json& one : answer["assigned"]) pairs.emplace_back(one["task"], one["robot"]);
  return pairs;
}

TEST(AssignEndpoint, GivesTasksAtTheLeastSumOfArrivals) {
  const Json answer = answer_to(two_tasks());
  EXPECT_THAT(pairs(answer), ElementsAre(Pair("near", "b"), Pair("far", "a")));
  EXPECT_TRUE(answer["unassigned"].empty());
  EXPECT_NEAR(answer["assigned"][1]["t_arrive"], 4.0 + 1.0 + 7.0, 1e-9);
}

TEST(AssignEndpoint, ReturnsTheRequestWithTheGoals) {
  const Json given = two_tasks();
  Json answer = answer_to(given);
  const Json& robots = answer["robots"];
  EXPECT_EQ(robots[0]["goals"], given["tasks"][1]["goals"]);
  EXPECT_EQ(robots[1]["goals"],
            Json::array({given["request"]["robots"][1]["goal"], given["tasks"][0]["goals"][0]}));
  EXPECT_FALSE(robots[1].contains("goal"));
  for (const char* member : {"map", "robot_defaults", "metadata"}) {
    EXPECT_EQ(answer[member], given["request"][member]) << member;
  }
  const Reply plan = plan_endpoint(answer.dump(), context());
  EXPECT_EQ(plan.status, 200) << plan.body;
  EXPECT_EQ(json_of(plan)["status"], "solved");
}

TEST(AssignEndpoint, IsTheIdentityWithoutTasks) {
  Json request = two_tasks();
  request["tasks"] = Json::array();
  Json answer = answer_to(request);
  EXPECT_TRUE(answer["assigned"].empty());
  answer.erase("assigned");
  answer.erase("unassigned");
  EXPECT_EQ(answer, request["request"]);
}

TEST(AssignEndpoint, TakesItsOwnAnswerForMoreTasks) {
  Json next{{"request", answer_to(two_tasks())}, {"tasks", two_tasks()["tasks"]}};
  next["tasks"].erase(1);
  const Json answer = answer_to(next);
  EXPECT_EQ(answer["assigned"].size(), 1U);
}

TEST(AssignEndpoint, GivesTasksOnlyToRobotsThatMayDoThem) {
  Json request = two_tasks();
  request["tasks"][0]["robots"] = {"a"};
  EXPECT_THAT(pairs(answer_to(request)), ElementsAre(Pair("near", "a"), Pair("far", "b")));
  request["tasks"][1]["robots"] = {"a"};
  const Json answer = answer_to(request);
  EXPECT_EQ(answer["assigned"].size(), 1U);
  EXPECT_THAT(answer["unassigned"][0]["reason"], "no_robot");
}

TEST(AssignEndpoint, CountsWeights) {
  Json request = two_tasks();
  request["request"]["robots"].erase(1);
  EXPECT_THAT(pairs(answer_to(request)), ElementsAre(Pair("near", "a")));
  request["tasks"][1]["weight"] = 10;
  EXPECT_THAT(pairs(answer_to(request)), ElementsAre(Pair("far", "a")))
      << "what is left out weighs the least";
}

TEST(AssignEndpoint, LetsHeavyTasksArriveFirst) {
  Json request = two_tasks();
  request["request"]["robots"][1] = {{"id", "b"}, {"start", {{"x", 3.5}, {"y", 2.5}}}};
  request["tasks"] = Json::parse(
      R"([{"id": "1", "goals": [{"x": 5.5, "y": 0.5}]}, {"id": "2", "goals": [{"x": 8.5, "y": 2.5}]}])");
  request["tasks"][0]["weight"] = 100;
  EXPECT_THAT(pairs(answer_to(request)), ElementsAre(Pair("1", "b"), Pair("2", "a")));
  request["tasks"][0]["weight"] = 0.01;
  EXPECT_THAT(pairs(answer_to(request)), ElementsAre(Pair("1", "a"), Pair("2", "b")));
}

TEST(AssignEndpoint, LeavesTasksWithoutAWayOut) {
  Json request = two_tasks();
  request["request"]["map"]["rows"] = {".........#..", ".........#..", ".........#.."};
  const Json answer = answer_to(request);
  EXPECT_THAT(pairs(answer), ElementsAre(Pair("near", "a")));
  EXPECT_EQ(answer["unassigned"], Json::parse(R"([{"task": "far", "reason": "no_way"}])"));
}

TEST(AssignEndpoint, KeepsToTheZonesOfEachRobot) {
  Json request = two_tasks();
  request["request"]["zones"] = Json::parse(R"([{"id": "z", "type": "blocked", "robots": ["a"],
    "polygon": [{"x": 7, "y": 0}, {"x": 8, "y": 0}, {"x": 8, "y": 3}, {"x": 7, "y": 3}]}])");
  EXPECT_THAT(pairs(answer_to(request)), ElementsAre(Pair("near", "a"), Pair("far", "b")));
}

TEST(AssignEndpoint, GivesNothingToInvalidRobots) {
  Json request = two_tasks();
  request["request"]["robots"][0]["start"] = {{"x", 0.1}, {"y", 0.5}};
  EXPECT_THAT(faults(request), ElementsAre(Pair("/request/robots/0/start", "start_in_obstacle")));
  request["request"]["options"] = {{"invalid_robots", "report"}};
  const Json answer = answer_to(request);
  ASSERT_EQ(answer["assigned"].size(), 1U);
  EXPECT_EQ(answer["assigned"][0]["robot"], "b");
}

TEST(AssignEndpoint, TellsEachFaultWithItsPlace) {
  Json request = two_tasks();
  request["tasks"][0]["id"] = "far";
  request["tasks"][0]["robots"] = {"c"};
  request["tasks"][0]["weight"] = 0;
  request["tasks"][1]["goals"][0].erase("x");
  request["tasks"].push_back(
      {{"id", "none"}, {"goals", Json::array()}, {"robots", Json::array()}, {"due", -1}});
  request["tasks"].push_back({{"id", "single"}, {"goal", {{"x", 1}, {"y", 1}}}});
  EXPECT_THAT(faults(request),
              testing::UnorderedElementsAre(
                  Pair("/tasks/1/id", "duplicate"), Pair("/tasks/0/robots/0", "unknown_robot"),
                  Pair("/tasks/0/weight", "out_of_range"), Pair("/tasks/1/goals/0/x", "missing"),
                  Pair("/tasks/2/goals", "empty"), Pair("/tasks/2/robots", "empty"),
                  Pair("/tasks/2/due", "out_of_range"), Pair("/tasks/3/goal", "unknown_key"),
                  Pair("/tasks/3/goals", "missing")));
}

TEST(AssignEndpoint, TellsFaultsOfRobotsFirst) {
  Json request = two_tasks();
  for (Json& robot : request["request"]["robots"]) robot["start"] = 1;
  EXPECT_THAT(faults(request), ElementsAre(Pair("/request/robots/0/start", "wrong_type"),
                                           Pair("/request/robots/1/start", "wrong_type")));
}

TEST(AssignEndpoint, RefusesTooManyPairs) {
  Json request = two_tasks();
  Json& tasks = request["tasks"];
  const Json one = tasks[0];
  for (int k = 2; k <= 125'000; ++k) tasks.push_back({{"id", std::to_string(k)}});
  EXPECT_THAT(faults(request), ElementsAre(Pair("/tasks", "out_of_range")));
}

}  // namespace TEST_FILE
}  // namespace fleetplan::api
