#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "api/endpoints/endpoints.h"
#include "tests/api/support/requests.h"

namespace fleetplan::api {
namespace TEST_FILE {

using testing::HasSubstr;

RequestContext context() {
  RequestContext context;
  context.request_id = "test";
  return context;
}

Json planned(const Json& request) { return json_of(plan_endpoint(request.dump(), context())); }

Json request_with_dependencies() {
  Json request = swap_request();
  request["options"] = {{"dependencies", true}, {"interval_margin", 0.5}};
  return request;
}

Json merged(Json request, const Json& answer) {
  for (const auto& [key, value] : answer.items()) request[key] = value;
  return request;
}

/// Robot b crosses the way of a, five seconds later.
Json crossing_plans() {
  return Json::parse(R"({
    "map": {"rows": ["......", "......", "......", "......", "......", "......"]},
    "robot_defaults": {"radius": 0.5, "linear_speed": 1, "angular_speed": 3},
    "robots": [{"id": "a", "start": {"x": 0.5, "y": 2.5}}, {"id": "b", "start": {"x": 2.5, "y": 0.5, "theta": 1.5707963267948966}}],
    "plans": [
      {"robot": "a", "actions": [{"type": "translate", "t_start": 0, "t_end": 4, "from": {"x": 0.5, "y": 2.5, "theta": 0}, "to": {"x": 4.5, "y": 2.5, "theta": 0}}]},
      {"robot": "b", "actions": [
        {"type": "wait", "t_start": 0, "t_end": 3, "from": {"x": 2.5, "y": 0.5, "theta": 1.5707963267948966}, "to": {"x": 2.5, "y": 0.5, "theta": 1.5707963267948966}},
        {"type": "translate", "t_start": 3, "t_end": 7, "from": {"x": 2.5, "y": 0.5, "theta": 1.5707963267948966}, "to": {"x": 2.5, "y": 4.5, "theta": 1.5707963267948966}}]}
    ]})");
}

Json crossing_request() {
  Json request = crossing_plans();
  request["robots"][0]["goal"] = {{"x", 4.5}, {"y", 2.5}};
  request["robots"][1]["goal"] = {{"x", 2.5}, {"y", 4.5}};
  return request;
}

TEST(DependenciesOfAPlan, AreThereOnlyIfAskedFor) {
  const Json without = planned(swap_request());
  EXPECT_FALSE(without.contains("dependencies"));
  EXPECT_FALSE(without.contains("tight"));
  const Json with = planned(request_with_dependencies());
  EXPECT_GT(with["dependencies"].size(), 0U);
  EXPECT_EQ(with["tight"].size(), 0U);
  Json plain = request_with_dependencies();
  plain["options"].erase("dependencies");
  EXPECT_EQ(planned(plain)["plans"], with["plans"]);
}

TEST(DependenciesOfAPlan, AreThoseOfTheEndpointForTheSamePlan) {
  const Json request = request_with_dependencies();
  const Json answer = planned(request);
  const Reply reply = dependencies_endpoint(merged(request, answer).dump(), context());
  ASSERT_EQ(reply.status, 200) << reply.body;
  const Json found = json_of(reply);
  EXPECT_EQ(found["dependencies"], answer["dependencies"]);
  EXPECT_EQ(found["tight"], answer["tight"]);
  EXPECT_EQ(found["warnings"].size(), 0U);
}

TEST(DependenciesOfAPlan, DoNotPreventItsCheck) {
  const Json request = request_with_dependencies();
  const Reply reply = validate_endpoint(merged(request, planned(request)).dump(), context());
  EXPECT_EQ(reply.status, 200) << reply.body;
  EXPECT_EQ(json_of(reply)["valid"], true);
}

TEST(DependenciesOfAPlan, UseTheMarginOfTheRobotBeforeThatOfTheOptions) {
  Json request = crossing_request();
  const auto gate = [&] {
    return json_of(dependencies_endpoint(request.dump(), context()))["dependencies"][0]["gate"]["progress"]
        .get<double>();
  };
  EXPECT_NEAR(gate(), 0.25, 1e-6);
  request["options"]["execution_margin"] = 0.1;
  EXPECT_NEAR(gate(), 0.2, 1e-6);
  request["robot_defaults"]["execution_margin"] = 0.0;
  EXPECT_NEAR(gate(), 0.25, 1e-6);
  request["robots"][0]["execution_margin"] = 0.2;
  EXPECT_NEAR(gate(), 0.2, 1e-6);
}

TEST(DependenciesOfAPlan, WarnOfMovingObstacles) {
  Json request = crossing_request();
  request["obstacles"] =
      Json::parse(R"([{"id": "p", "radius": 0.2, "motion": [{"t": 0, "x": 5.5, "y": 5.5}]}])");
  const Json found = json_of(dependencies_endpoint(request.dump(), context()));
  ASSERT_EQ(found["warnings"].size(), 1U);
  EXPECT_THAT(found["warnings"][0].get<std::string>(), HasSubstr("obstacles"));
}

TEST(DependenciesOfAPlan, AreRefusedIfThePlansCollide) {
  Json request = crossing_request();
  for (Json& action : request["plans"][1]["actions"]) {
    action["t_start"] = std::max(0.0, action["t_start"].get<double>() - 3.0);
    action["t_end"] = action["t_end"].get<double>() - 3.0;
  }
  request["plans"][1]["actions"].erase(0);
  const Reply reply = dependencies_endpoint(request.dump(), context());
  EXPECT_EQ(reply.status, 422);
  const Json problem = json_of(reply);
  EXPECT_EQ(problem["code"], "invalid_request");
  ASSERT_EQ(problem["errors"].size(), 1U) << reply.body;
  EXPECT_EQ(problem["errors"][0]["pointer"], "/plans/1/actions/0");
  EXPECT_EQ(problem["errors"][0]["code"], "invalid_plan");
}

Json retime_request() {
  Json request = crossing_request();
  const Json found = json_of(dependencies_endpoint(request.dump(), context()));
  request.erase("map");
  request["dependencies"] = found["dependencies"];
  request["at"] = 1.0;
  request["states"] = Json::parse(R"([{"robot": "a", "action": 0, "progress": 0.25, "held_s": 4}])");
  return request;
}

TEST(NewTimes, TellWhoIsLateBecauseOfWhom) {
  const Reply reply = retime_endpoint(retime_request().dump(), context());
  ASSERT_EQ(reply.status, 200) << reply.body;
  const Json found = json_of(reply);
  ASSERT_EQ(found["robots"].size(), 2U);
  EXPECT_NEAR(found["robots"][0]["t_end"].get<double>(), 8.0, 1e-9);
  EXPECT_NEAR(found["robots"][0]["visits"][0]["t_arrive"].get<double>(), 8.0, 1e-9);
  EXPECT_TRUE(found["robots"][0]["visits"][0]["t_leave"].is_null());
  EXPECT_EQ(found["robots"][1]["actions"].size(), 2U);
  EXPECT_NEAR(found["robots"][1]["delay"].get<double>(), 3.0, 1e-5);
  EXPECT_EQ(found["late"][0]["waits_for"], nullptr);
  EXPECT_EQ(found["late"][1]["robot"], "b");
  EXPECT_EQ(found["late"][1]["waits_for"], "a");
  EXPECT_EQ(found["late"][1]["because_of"], "a");
}

TEST(NewTimes, ReportFaultsOfStatesAndPlans) {
  Json request = retime_request();
  request["states"] = Json::parse(R"([{"robot": "a", "action": 1, "progress": 0.5},
    {"robot": "b", "action": 0, "progress": 2, "speed_factor": 0}, {"robot": "b", "action": 0, "progress": 0},
    {"robot": "c", "action": 0, "progress": 0, "held": 1}])");
  request["plans"][1]["actions"][1]["t_start"] = 3.5;
  request["dependencies"] = Json::array();
  const Reply reply = retime_endpoint(request.dump(), context());
  EXPECT_EQ(reply.status, 422);
  EXPECT_EQ(faults_in(reply), (Faults{{"/plans/1/actions/1/t_start", "discontinuity"},
                                      {"/states/0/action", "out_of_range"},
                                      {"/states/1/progress", "out_of_range"},
                                      {"/states/1/speed_factor", "out_of_range"},
                                      {"/states/2/robot", "duplicate"},
                                      {"/states/3/robot", "unknown_robot"},
                                      {"/states/3/held", "unknown_key"}}));
}

}  // namespace TEST_FILE
}  // namespace fleetplan::api
