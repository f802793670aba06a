// Zones with "enter": false: what requests may have, what answers tell, and later moments of their plans.

#include <gtest/gtest.h>

#include <string>

#include "api/endpoints/endpoints.h"
#include "tests/api/support/answers.h"
#include "tests/api/support/requests.h"

namespace fleetplan::api {
namespace TEST_FILE {

/// One robot inside of the zone, and one outside whose second goal is inside.
Json hall_request() {
  return Json::parse(R"({
    "map": {"rows": ["............", "............", "............", "............", "............"],
            "origin": {"x": 100, "y": 50}},
    "robot_defaults": {"radius": 0.3, "linear_speed": 1.0, "angular_speed": 3.0},
    "robots": [
      {"id": "in", "start": {"x": 106.5, "y": 53.5}, "goal": {"x": 111.5, "y": 54.5}},
      {"id": "out", "start": {"x": 100.5, "y": 50.5},
       "goals": [{"x": 100.5, "y": 54.5, "service": 2}, {"x": 106.5, "y": 52.5, "metadata": {"order": 7}},
                 {"x": 111.5, "y": 50.5}]}],
    "zones": [{"id": "fire", "type": "blocked", "enter": false, "polygon": [
      {"x": 104, "y": 51}, {"x": 109, "y": 51}, {"x": 109, "y": 54}, {"x": 104, "y": 54}]}]})");
}

Json merged(Json request, const Json& answer) {
  for (const auto& [key, value] : answer.items()) request[key] = value;
  return request;
}

TEST(ClosedZones, AnswersTellWhichGoalsArePutOff) {
  const Json answer = plan_of(hall_request());
  EXPECT_EQ(answer["status"], "solved");
  const Json& in = answer["plans"][0];
  EXPECT_FALSE(in.contains("ends_at"));
  EXPECT_FALSE(in.contains("visits"));
  const Json& out = answer["plans"][1];
  EXPECT_EQ(out["ends_at"], "zone");
  EXPECT_EQ(out["actions"].back()["to"]["y"], 54.5);
  ASSERT_EQ(out["visits"].size(), 3U);
  EXPECT_TRUE(out["visits"][0]["t_arrive"].is_number());
  EXPECT_EQ(out["visits"][0]["t_leave"], out["cost"]);
  EXPECT_EQ(out["visits"][1], Json::parse(R"({"goal": 1, "t_arrive": null, "t_leave": null,
                                              "reason": "zone_closed", "zone": "fire", "metadata": {"order": 7}})"));
  EXPECT_EQ(out["visits"][2],
            Json::parse(R"({"goal": 2, "t_arrive": null, "t_leave": null, "reason": "goal_before"})"));
}

TEST(ClosedZones, TheSamePlansAreValidForTheCheck) {
  const Json request = hall_request();
  const Json answer = plan_of(request);
  const Reply reply = validate_endpoint(merged(request, answer).dump(), {});
  EXPECT_EQ(json_of(reply)["valid"], true) << reply.body;
  Json other = merged(request, answer);
  other["plans"][1]["actions"] = Json::array();
  other["plans"][1].erase("visits");
  other["plans"][1].erase("cost");
  const Reply without = validate_endpoint(other.dump(), {});
  EXPECT_EQ(json_of(without)["violations"][0]["kind"], "wrong_visit") << without.body;
}

TEST(ClosedZones, ALaterMomentKeepsTheGoalsThatArePutOff) {
  Json request = hall_request();
  const Json answer = plan_of(request);
  for (const double at : {0.5, 2.0, 7.0, 60.0}) {
    const Json body{{"request", request}, {"plans", answer["plans"]}, {"at", at}, {"commit", 1.0}};
    const Reply reply = advance_endpoint(body.dump(), {});
    ASSERT_EQ(reply.status, 200) << reply.body;
    Json next = json_of(reply);
    EXPECT_EQ(next["zones"], request["zones"]);
    const Json later = plan_of(next);
    EXPECT_EQ(later["status"], "solved") << later;
    EXPECT_EQ(later["plans"][1]["ends_at"], "zone");
    EXPECT_EQ(later["plans"][1]["visits"].back()["reason"], "goal_before");
    next.erase("zones");
    EXPECT_FALSE(plan_of(next)["plans"][1].contains("ends_at")) << "open again";
  }
}

TEST(ClosedZones, AZoneOverARobotUnderWayRefusesNothing) {
  Json request = hall_request();
  request.erase("zones");
  const Json answer = plan_of(request);
  for (double at = 0.5; at < 12.0; at += 0.5) {
    const Json body{{"request", request}, {"plans", answer["plans"]}, {"at", at}, {"commit", 1.0}};
    Json next = json_of(advance_endpoint(body.dump(), {}));
    next["zones"] = hall_request()["zones"];
    const Json later = plan_of(next);
    EXPECT_EQ(later["status"], "solved") << at << ": " << later;
    const Reply check = validate_endpoint(merged(next, later).dump(), {});
    EXPECT_EQ(json_of(check)["valid"], true) << at << ": " << check.body;
  }
}

TEST(ClosedZones, ARobotThatLeavesWithoutAnotherGoalRestsOutside) {
  Json request = hall_request();
  request["robots"][0]["goal"] = {{"x", 105.5}, {"y", 52.5}};
  const Json answer = plan_of(request);
  const Json& in = answer["plans"][0];
  EXPECT_EQ(in["ends_at"], "zone");
  EXPECT_EQ(in["visits"], Json::parse(R"([{"goal": 0, "t_arrive": null, "t_leave": null,
                                           "reason": "zone_closed", "zone": "fire"}])"));
  EXPECT_GE(in["actions"].back()["to"]["y"].get<double>(), 54.3 - 1e-6);
  const Reply check = validate_endpoint(merged(request, answer).dump(), {});
  EXPECT_EQ(json_of(check)["valid"], true) << check.body;
}

TEST(ClosedZones, ARobotThatIsParkedOnTheOnlyWayOutIsNamed) {
  Json request = Json::parse(R"({
    "map": {"rows": ["............"]},
    "robot_defaults": {"radius": 0.3, "linear_speed": 1.0, "angular_speed": 3.0},
    "robots": [{"id": "in", "start": {"x": 1.5, "y": 0.5}, "goal": {"x": 2.5, "y": 0.5}},
               {"id": "parked", "start": {"x": 3.5, "y": 0.5}}],
    "zones": [{"id": "fire", "type": "blocked", "enter": false, "polygon": [
      {"x": 0, "y": 0}, {"x": 5, "y": 0}, {"x": 5, "y": 1}, {"x": 0, "y": 1}]}]})");
  for (const double goal : {2.5, 10.5}) {  // inside, so that it is put off, and outside
    request["robots"][0]["goal"]["x"] = goal;
    request["options"] = Json::object();
    const Json in = plan_of(request)["unplanned"][0];
    EXPECT_EQ(in["robot"], "in");
    EXPECT_EQ(in["reason"], "blocked_by_robots");
    EXPECT_EQ(in["blocked_by"], Json({"parked"}));

    request["options"]["horizon"] = 5.0;
    const Json waits = plan_of(request)["plans"][0];
    EXPECT_EQ(waits["stuck"], true);
    EXPECT_EQ(waits["blocked_by"], Json({"parked"}));
  }
}

TEST(ClosedZones, WithoutEnterStartsAndGoalsInsideAreFaults) {
  Json request = hall_request();
  request["zones"][0].erase("enter");
  EXPECT_EQ(brief_faults_of(request),
            (Faults{{"/robots/0/start", "start_in_obstacle"}, {"/robots/1/goals/1", "goal_in_obstacle"}}));
}

TEST(ClosedZones, EnterIsFalseAndForBlockedZones) {
  Json request = hall_request();
  request["zones"][0]["enter"] = true;
  EXPECT_EQ(brief_faults_of(request), (Faults{{"/zones/0/enter", "out_of_range"}}));
  request["zones"][0]["enter"] = "no";
  EXPECT_EQ(brief_faults_of(request), (Faults{{"/zones/0/enter", "wrong_type"}}));
  request["zones"][0]["enter"] = false;
  request["zones"][0]["type"] = "speed";
  request["zones"][0]["linear_speed"] = 0.5;
  EXPECT_EQ(brief_faults_of(request), (Faults{{"/zones/0/enter", "unknown_key"}}));
  EXPECT_NE(detail_of(request).find("blocked only"), std::string::npos);
}

/// A robot that is committed to serve its first goal, to wait, and that has its other goals inside of the
/// zone.
Json serving_request(double radius_after) {
  Json request = hall_request();
  request["robots"].erase(0);
  Json& robot = request["robots"][0];
  robot["start"]["theta"] = 0.0;
  robot["goals"][0] = {{"x", 100.5}, {"y", 50.5}, {"service", 2}, {"radius_after", radius_after}};
  Json wait{
      {"type", "wait"}, {"t_start", 0.0}, {"t_end", 5.0}, {"from", robot["start"]}, {"to", robot["start"]}};
  robot["committed"] = Json::array({wait});  // compilers differ about what {wait} is
  return request;
}

TEST(ClosedZones, WhatCommitmentsServeIsServedIfAllOtherGoalsArePutOff) {
  for (const double x : {100.5, 105.5}) {  // outside, and inside, from where it leaves
    Json request = serving_request(0.35);
    request["robots"][0]["start"]["x"] = request["robots"][0]["goals"][0]["x"] = x;
    request["robots"][0]["start"]["y"] = request["robots"][0]["goals"][0]["y"] = x > 104.0 ? 52.5 : 50.5;
    for (const char* end : {"from", "to"}) {
      request["robots"][0]["committed"][0][end] = request["robots"][0]["start"];
    }
    const Json answer = plan_of(request);
    ASSERT_EQ(answer["status"], "solved") << answer;
    const Json& plan = answer["plans"][0];
    EXPECT_EQ(plan["ends_at"], "zone");
    ASSERT_EQ(plan["visits"].size(), 3U) << plan;
    EXPECT_EQ(plan["visits"][0]["t_leave"], 2.0);
    EXPECT_EQ(plan["visits"][1]["reason"], "zone_closed");
    EXPECT_EQ(json_of(validate_endpoint(merged(request, answer).dump(), {}))["valid"], true);
    const Json body{{"request", request}, {"plans", answer["plans"]}, {"at", 3.0}};
    const Json next = json_of(advance_endpoint(body.dump(), {}));
    EXPECT_EQ(next["robots"][0]["radius"], 0.35) << next;
    EXPECT_EQ(next["robots"][0]["goals"].size(), 2U);
  }
}

TEST(ClosedZones, OthersMakeRoomForALoadThatACommitmentTakes) {
  Json request = serving_request(0.5);
  request["robots"].push_back(
      {{"id", "by"}, {"start", {{"x", 101.25}, {"y", 50.5}}}, {"goal", {{"x", 103}, {"y", 50.5}}}});
  const Json answer = plan_of(request);
  EXPECT_EQ(json_of(validate_endpoint(merged(request, answer).dump(), {}))["valid"], true) << answer;
  const Json body{{"request", request}, {"plans", answer["plans"]}, {"at", 3.0}};
  EXPECT_EQ(json_of(advance_endpoint(body.dump(), {}))["robots"][0]["radius"], 0.5);
}

TEST(ClosedZones, AGoalThatIsPutOffAtTheStartIsNotServedLater) {
  Json request = hall_request();
  request["robots"].erase(1);
  Json& robot = request["robots"][0];
  robot.erase("goal");
  robot["goals"] = {robot["start"], {{"x", 111.5}, {"y", 54.5}}};
  robot["goals"][0]["radius_after"] = 0.5;
  const Json answer = plan_of(request);
  ASSERT_EQ(answer["plans"][0]["visits"][0]["reason"], "zone_closed") << answer;
  const Json body{{"request", request}, {"plans", answer["plans"]}, {"at", 1.0}};
  const Json next = json_of(advance_endpoint(body.dump(), {}));
  EXPECT_EQ(next["robots"][0]["goals"].size(), 2U) << "as the plan says";
  EXPECT_EQ(next["robots"][0].value("radius", 0.3), 0.3);
}

}  // namespace TEST_FILE
}  // namespace fleetplan::api
