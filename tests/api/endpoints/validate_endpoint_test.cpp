#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <stop_token>

#include "api/endpoints/endpoints.h"
#include "tests/api/support/requests.h"
#include "tests/api/support/test_turn.h"

namespace fleetplan::api {
namespace TEST_FILE {

using testing::ElementsAre;

Json validated(const Json& request) {
  const Reply reply = validate_endpoint(request.dump(), {});
  EXPECT_EQ(reply.status, 200) << reply.body;
  return json_of(reply);
}

/// Robot "a" drives ahead 3 m; "b" has no plan.
Json drive_request() {
  Json request = swap_request();
  request["robots"][0]["goal"] = {{"x", 3.5}, {"y", 1.5}};
  request["plans"] = Json::parse(R"([{"robot": "a", "cost": 3.0, "actions": [
    {"type": "translate", "t_start": 0, "t_end": 3.0, "from": {"x": 0.5, "y": 1.5, "theta": 0},
     "to": {"x": 3.5, "y": 1.5, "theta": 0}}]}])");
  return request;
}

Json& action(Json& request) { return request["plans"][0]["actions"][0]; }

std::vector<std::string> kinds_of(const Json& answer) {
  std::vector<std::string> kinds;
  for (const auto& violation : answer["violations"]) kinds.push_back(violation["kind"]);
  return kinds;
}

Faults faults_of_validation(const Json& request) {
  const Reply reply = validate_endpoint(request.dump(), {});
  EXPECT_EQ(reply.status, 422);
  return faults_in(reply);
}

TEST(ValidateEndpoint, AcceptsAGoodPlan) {
  const Json answer = validated(drive_request());
  EXPECT_EQ(answer["valid"], true);
  EXPECT_EQ(answer["violations"], Json::array());
  EXPECT_NEAR(answer["min_clearance"].get<double>(), 4.4, 1e-9);
}

TEST(ValidateEndpoint, AcceptsTheAnswerOfAVeryLongPlan) {
  Json request = Json::parse(R"({
    "map": {"rows": ["....."], "resolution": 2e5},
    "robots": [{"id": "a", "radius": 1.0, "linear_speed": 7e-3, "angular_speed": 1e-3,
                "start": {"x": 2e5, "y": 1e5}, "goal": {"x": 8e5, "y": 1e5}}]})");
  const Reply reply = plan_endpoint(request.dump(), {});
  ASSERT_EQ(reply.status, 200) << reply.body;
  request.update(json_of(reply));
  EXPECT_GT(request["makespan"], 8e7);
  EXPECT_EQ(validated(request)["violations"], Json::array());
}

TEST(ValidateEndpoint, AcceptsAWholeAnswerAddedToItsRequest) {
  Json request = swap_request();
  request["map"]["origin"] = {{"x", 10.0}, {"y", -5.0}};
  for (auto& robot : request["robots"]) {
    for (const char* pose : {"start", "goal"}) {
      robot[pose]["x"] = robot[pose]["x"].get<double>() + 10.0;
      robot[pose]["y"] = robot[pose]["y"].get<double>() - 5.0;
    }
  }
  request["options"] = {{"seed", 3}};
  request.update(json_of(plan_endpoint(request.dump(), {})));
  EXPECT_EQ(validated(request)["valid"], true);
}

TEST(ValidateEndpoint, CountsItsWaitAgainstItsBudget) {
  Json request = drive_request();
  request["options"] = {{"time_budget_ms", 60'000}};
  TestTurn turn;
  RequestContext context;
  context.turn = &turn;
  EXPECT_EQ(validate_endpoint(request.dump(), context).status, 200);
  EXPECT_EQ(turn.need->kind, TurnNeed::Kind::check);
  EXPECT_EQ(turn.need->stop.deadline(), context.received_at + std::chrono::milliseconds(60'000));
  EXPECT_EQ(turn.need->work, 3.0) << "two robots and an action";
  EXPECT_TRUE(turn.need->is_short);
}

TEST(ValidateEndpoint, IsNoShortRequestWithABodyOfMoreThanAMebibyte) {
  TestTurn turn;
  RequestContext context;
  context.turn = &turn;
  const std::string body = drive_request().dump();
  const std::string spaces((1 << 20) - body.size(), ' ');
  EXPECT_EQ(validate_endpoint(body + spaces, context).status, 200);
  EXPECT_TRUE(turn.need->is_short);
  EXPECT_EQ(validate_endpoint(body + spaces + ' ', context).status, 200);
  EXPECT_FALSE(turn.need->is_short);
}

TEST(ValidateEndpoint, IsOverloadedWithoutATurn) {
  TestTurn turn;
  RequestContext context;
  context.turn = &turn;
  turn.comes = false;
  EXPECT_EQ(json_of(validate_endpoint(drive_request().dump(), context))["code"], "overloaded");
  turn.refuses = true;
  EXPECT_EQ(json_of(validate_endpoint(drive_request().dump(), context))["code"], "overloaded");
}

TEST(ValidateEndpoint, UsesTheEndOfTheLastActionAsCost) {
  Json request = drive_request();
  request["plans"][0].erase("cost");
  EXPECT_EQ(validated(request)["valid"], true);
}

TEST(ValidateEndpoint, IgnoresTheLowerBoundOfAPlan) {
  Json request = drive_request();
  for (const Json& bound : {Json(3.0), Json(1e9), Json("none"), Json()}) {
    request["plans"][0]["lower_bound"] = bound;
    EXPECT_EQ(validated(request)["valid"], true) << bound;
  }
}

TEST(ValidateEndpoint, ReportsARobotThatIsTooFast) {
  Json request = drive_request();
  action(request)["t_end"] = 1.5;
  request["plans"][0]["cost"] = 1.5;
  const Json answer = validated(request);
  EXPECT_EQ(answer["valid"], false);
  ASSERT_THAT(kinds_of(answer), ElementsAre("speed"));
  const Json& violation = answer["violations"][0];
  EXPECT_EQ(violation["robots"], Json::array({"a"}));
  EXPECT_NEAR(violation["distance"].get<double>(), 2.0, 1e-9);
  EXPECT_EQ(violation["required"], 1.0);
  EXPECT_FALSE(violation["detail"].get<std::string>().empty());
}

TEST(ValidateEndpoint, ReportsACollisionWithARobotThatHasNoPlan) {
  Json request = drive_request();
  request["robots"][1]["start"]["x"] = 2.5;
  const Json answer = validated(request);
  ASSERT_THAT(kinds_of(answer), ElementsAre("robot_collision"));
  EXPECT_EQ(answer["violations"][0]["robots"], Json::array({"a", "b"}));
  EXPECT_NEAR(answer["violations"][0]["t"].get<double>(), 2.0, 1e-6);
}

TEST(ValidateEndpoint, ReportsOverlappingStartsAsViolations) {
  Json request = drive_request();
  request["plans"] = Json::array();
  request["robots"][1]["start"]["x"] = 0.7;
  EXPECT_THAT(kinds_of(validated(request)), ElementsAre("robot_collision"));
}

TEST(ValidateEndpoint, ReportsAWallAndAWrongGoal) {
  Json request = drive_request();
  action(request)["to"]["x"] = 4.5;
  action(request)["t_end"] = 4.0;
  request["plans"][0]["cost"] = 4.0;
  EXPECT_THAT(kinds_of(validated(request)),
              testing::UnorderedElementsAre("obstacle_collision", "wrong_goal"));
}

TEST(ValidateEndpoint, UsesTheGivenTolerance) {
  Json request = drive_request();
  action(request)["from"]["x"] = 0.505;
  EXPECT_EQ(validated(request)["valid"], false);
  request["tolerance"] = 0.01;
  EXPECT_EQ(validated(request)["valid"], true);
  request["tolerance"] = -1;
  EXPECT_THAT(faults_of_validation(request), ElementsAre(testing::Pair("/tolerance", "out_of_range")));
}

TEST(ValidateEndpoint, ReportsFaultsOfThePlans) {
  Json request = drive_request();
  action(request)["type"] = "fly";
  action(request)["to"].erase("theta");
  action(request)["speed"] = 1;
  action(request).erase("t_start");
  request["plans"].push_back(Json::parse(R"({"robot": "a", "actions": []})"));
  request["plans"].push_back(Json::parse(R"({"robot": "z", "actions": []})"));
  request["plans"].push_back(Json::parse(R"({"robot": "b"})"));
  request["plan"] = 1;
  EXPECT_EQ(faults_of_validation(request), (Faults{{"/plans/0/actions/0/type", "unknown_value"},
                                                   {"/plans/0/actions/0/to/theta", "missing"},
                                                   {"/plans/0/actions/0/speed", "unknown_key"},
                                                   {"/plans/0/actions/0/t_start", "missing"},
                                                   {"/plans/1/robot", "duplicate"},
                                                   {"/plans/2/robot", "unknown_robot"},
                                                   {"/plans/3/actions", "missing"},
                                                   {"/plan", "unknown_key"}}));
}

TEST(ValidateEndpoint, RequiresPlans) {
  EXPECT_EQ(faults_of_validation(swap_request()), (Faults{{"/plans", "missing"}}));
}

/// Robots that move to and fro at nearly the same place: every pair overlaps at all times.
Json heap_request(int robots, int actions) {
  Json request = drive_request();
  request["robots"].clear();
  request["plans"].clear();
  for (int k = 0; k < robots; ++k) {
    const std::string id = std::string("r") + std::to_string(k);
    const double x = 2.0 + 0.001 * k;
    request["robots"].push_back({{"id", id}, {"start", {{"x", x}, {"y", 1.5}}}});
    Json moves = Json::array();
    for (int i = 0; i < actions; ++i) {
      const double t = 0.01 * i;
      const double dx = i % 2 == 0 ? 0.0 : 0.005;
      moves.push_back({{"type", "translate"},
                       {"t_start", t},
                       {"t_end", t + 0.01},
                       {"from", {{"x", x + dx}, {"y", 1.5}, {"theta", 0}}},
                       {"to", {{"x", x + 0.005 - dx}, {"y", 1.5}, {"theta", 0}}}});
    }
    request["plans"].push_back({{"robot", id}, {"cost", 0.01 * actions}, {"actions", moves}});
  }
  return request;
}

TEST(ValidateEndpoint, StopsWhenTheBudgetIsSpent) {
  RequestContext context;
  context.limits.default_budget_ms = 1;
  context.received_at -= std::chrono::seconds(1);  // spent; what is so short is read all the same
  const Reply reply = validate_endpoint(heap_request(10, 20).dump(), context);
  EXPECT_EQ(reply.status, 422);
  EXPECT_EQ(json_of(reply)["code"], "check_unfinished");
  Json patient = heap_request(10, 20);
  patient["options"] = {{"time_budget_ms", 100'000}};
  EXPECT_EQ(validate_endpoint(patient.dump(), context).status, 200);
}

TEST(ValidateEndpoint, HasAtLeastTheDefaultBudget) {
  Json request = drive_request();
  request["options"] = {{"time_budget_ms", 1}};
  request["plans"][0]["actions"] = heap_request(1, 2000)["plans"][0]["actions"];
  EXPECT_EQ(validate_endpoint(request.dump(), {}).status, 200);
}

TEST(ValidateEndpoint, StopsOnRequest) {
  std::stop_source stop;
  stop.request_stop();
  RequestContext context;
  context.stop = stop.get_token();
  const Reply reply = validate_endpoint(heap_request(2, 10).dump(), context);
  EXPECT_EQ(reply.status, 503);
  EXPECT_EQ(json_of(reply)["code"], "draining");
  EXPECT_EQ(json_of(reply)["detail"], "The service is shutting down: try another replica.");
}

TEST(ValidateEndpoint, ReturnsAtMostTwentyViolationsAndTheNumberOfAll) {
  Json request = drive_request();
  const Json jump = action(request);
  for (int count = 0; count < 1100; ++count) request["plans"][0]["actions"].push_back(jump);
  const Json answer = validated(request);
  EXPECT_EQ(answer["violations"].size(), 20U);
  EXPECT_GT(answer["violations_total"], 1100);
  EXPECT_EQ(answer["truncated"], true);
  EXPECT_EQ(validated(drive_request())["violations_total"], 0);
  EXPECT_FALSE(validated(drive_request()).contains("truncated"));
}

TEST(ValidateEndpoint, JudgesTheVicinityOfRobots) {
  Json request = drive_request();
  request["robots"][1]["start"] = {{"x", 2.0}, {"y", 0.5}};
  EXPECT_EQ(validated(request)["valid"], true);
  request["robot_defaults"]["vicinity"] = 0.25;
  const Json answer = validated(request);
  EXPECT_EQ(kinds_of(answer), std::vector<std::string>{"robot_collision"});
  EXPECT_NEAR(answer["violations"][0]["required"].get<double>(), 1.1, 1e-12);
  EXPECT_NEAR(answer["min_clearance"].get<double>(), 0.4, 1e-9);
  request["robots"][1]["vicinity"] = 0.1;
  EXPECT_EQ(validated(request)["valid"], true) << "0.6 m + 0.35 m";
}

}  // namespace TEST_FILE
}  // namespace fleetplan::api
