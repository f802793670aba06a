// Goals that are served at one of several poses, from the request to the next moment.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>
#include <string>
#include <vector>

#include "api/endpoints/endpoints.h"
#include "tests/api/support/answers.h"
#include "tests/api/support/fault_case.h"
#include "tests/api/support/motion_requests.h"

namespace fleetplan::api {

namespace TEST_FILE {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Pair;

/// Docks at x = 8.5, one above the other from y = 0.5 on.
Json docks(int count) {
  Json poses = Json::array();
  for (int k = 0; k < count; ++k) poses.push_back({{"x", 8.5}, {"y", 0.5 + k}, {"theta", 0.0}});
  return poses;
}

/// Robots at x = 0.5 on a floor of 10 m x 5 m, each of which may take any of the docks.
Json dock_request(const std::vector<double>& starts, int count) {
  Json request{{"map", {{"rows", std::vector<std::string>(5, std::string(10, '.'))}}},
               {"robot_defaults", {{"radius", 0.3}, {"linear_speed", 1.0}, {"angular_speed", 2.0}}},
               {"robots", Json::array()}};
  for (const double y : starts) {
    request["robots"].push_back({{"id", "r" + std::to_string(request["robots"].size())},
                                 {"start", pose(0.5, y)},
                                 {"goal", {{"any_of", docks(count)}}}});
  }
  return request;
}

Json choice(const Json& answer, std::size_t robot, std::size_t visit = 0) {
  return answer["plans"][robot]["visits"][visit]["choice"];
}

TEST(OpenGoals, TheNearestPoseIsChosenAndTold) {
  const Json request = dock_request({2.5}, 5);
  const Json answer = plan_of(request);
  EXPECT_EQ(choice(answer, 0), 2);
  EXPECT_EQ(answer["plans"][0]["cost"], 8.0);
  EXPECT_EQ(answer["plans"][0]["actions"].back()["to"]["y"], 2.5);
  EXPECT_EQ(verdict_of(request, answer)["violations"], Json::array());
}

TEST(OpenGoals, BiasCountsInTheChoiceAndNotInTimes) {
  Json request = dock_request({2.5}, 5);
  request["robots"][0]["goal"]["any_of"][2]["bias"] = 0.1;
  EXPECT_EQ(choice(plan_of(request), 0), 2) << "a turn to another one takes longer";
  request["robots"][0]["goal"]["any_of"][2]["bias"] = 60;
  const Json answer = plan_of(request);
  EXPECT_NE(choice(answer, 0), 2);
  EXPECT_LT(answer["plans"][0]["cost"], 12.0);
}

TEST(OpenGoals, RobotsThatStayGetDifferentPosesAtTheLeastSum) {
  const Json request = dock_request({2.5, 1.5, 3.5, 0.5, 4.5}, 5);
  const Json answer = plan_of(request);
  EXPECT_EQ(answer["status"], "solved");
  EXPECT_EQ(answer["flowtime"], 40.0) << "each the one in front of it";
  EXPECT_EQ(verdict_of(request, answer)["violations"], Json::array());
}

TEST(OpenGoals, PosesThatAreNearInStraightLinesMayBeFar) {
  Json request = dock_request({2.5}, 5);
  // A wall around the nearest dock, open on the far side only.
  request["map"]["rows"] = {"..........", ".......##.", ".......#..", ".......##.", ".........."};
  EXPECT_NE(choice(plan_of(request), 0), 2);
}

TEST(OpenGoals, PosesThatDoNotFitAndThoseOfOthersAreLeftOut) {
  Json request = dock_request({2.5, 1.5}, 3);
  request["map"]["rows"][2] = "........#.";
  request["robots"][1]["goal"] = {{"x", 8.5}, {"y", 1.5}};
  request["robots"].push_back({{"id", "parked"}, {"start", pose(8.5, 4.5)}});
  request["robots"][0]["goal"]["any_of"].push_back(pose(8.5, 4.5));
  EXPECT_EQ(choice(plan_of(request), 0), 0);
}

TEST(OpenGoals, ARobotThatIsBlockedIsPlannedWithAnotherPose) {
  Json request = dock_request({2.5}, 2);
  // The docks are in rooms of their own; a parked robot fills the door of the nearer one.
  request["map"]["rows"] = {"..........", "......####", "..........", "......####", ".........."};
  request["robots"][0]["goal"]["any_of"] = {pose(8.5, 2.5), pose(8.5, 0.5)};
  request["robots"].push_back({{"id", "parked"}, {"start", pose(6.5, 2.5)}});
  const Json answer = plan_of(request);
  EXPECT_EQ(answer["status"], "solved");
  EXPECT_EQ(choice(answer, 0), 1);
  EXPECT_EQ(verdict_of(request, answer)["violations"], Json::array());
}

TEST(OpenGoals, AreGoalsOnTheWayToo) {
  Json request = dock_request({0.5, 2.5, 4.5}, 2);
  for (Json& robot : request["robots"]) {
    Json station = robot["goal"];
    station["service"] = 5.0;
    robot["goals"] = {station, robot["start"]};
    robot.erase("goal");
  }
  const Json answer = plan_of(request);
  ASSERT_EQ(answer["status"], "solved") << answer.dump();
  std::set<Json> chosen;
  for (std::size_t k = 0; k < 3; ++k) {
    chosen.insert(choice(answer, k));
    EXPECT_FALSE(answer["plans"][k]["visits"][1].contains("choice"));
  }
  EXPECT_EQ(chosen.size(), 2U) << "nobody waits where another one is free";
  EXPECT_EQ(verdict_of(request, answer)["violations"], Json::array());
}

TEST(OpenGoals, MoreRobotsThanPosesMayYieldInTurn) {
  Json request = dock_request({0.5, 2.5, 4.5}, 2);
  const auto faults = faults_of(request.dump());
  ASSERT_EQ(faults.size(), 1U);
  EXPECT_EQ(faults.front().code, "goals_overlap");
  EXPECT_THAT(faults.front().pointer, testing::MatchesRegex("/robots/[0-9]/goal/any_of"));
  EXPECT_THAT(faults.front().detail, HasSubstr("give more poses"));
  for (Json& robot : request["robots"]) {
    robot["idle"] = "yield";
    robot["goal"]["service"] = 3.0;
  }
  const Json answer = plan_of(request);
  EXPECT_EQ(answer["status"], "solved") << answer.dump();
  EXPECT_EQ(verdict_of(request, answer)["violations"], Json::array());
}

TEST(OpenGoals, TheCheckLooksAtThePoseThatIsNamed) {
  const Json request = dock_request({2.5}, 5);
  Json answer = plan_of(request);
  answer["plans"][0]["visits"][0]["choice"] = 3;
  EXPECT_FALSE(verdict_of(request, answer)["violations"].empty());
  answer["plans"][0]["visits"][0].erase("choice");
  EXPECT_EQ(verdict_of(request, answer)["violations"], Json::array()) << "the actions tell";
  answer["plans"][0].erase("visits");
  EXPECT_EQ(verdict_of(request, answer)["violations"], Json::array());
  answer["plans"][0]["actions"].back()["to"]["x"] = 8.0;
  EXPECT_FALSE(verdict_of(request, answer)["violations"].empty());
}

TEST(OpenGoals, StayOpenUntilTheServiceBegins) {
  Json request = dock_request({2.5}, 5);
  request["robots"][0]["goal"]["service"] = 4.0;
  const Json answer = plan_of(request);
  const Json on_the_way = advanced(request, answer, 3.0);
  Json open = request["robots"][0]["goal"];
  open["choice"] = 2;  // where the previous plan serves it
  const auto in_any_order = [](const Json& json) { return nlohmann::json::parse(json.dump()); };
  EXPECT_EQ(in_any_order(on_the_way["robots"][0]["goal"]), in_any_order(open));
  const Json planned = plan_of(on_the_way);
  EXPECT_EQ(choice(planned, 0), 2);
  EXPECT_NEAR(planned["plans"][0]["cost"].get<double>(), 9.0, 1e-6);
  const Json served = advanced(request, answer, 10.0);
  EXPECT_FALSE(served["robots"][0]["goal"].contains("any_of"));
  EXPECT_EQ(served["robots"][0]["goal"]["y"], 2.5);
  EXPECT_NEAR(served["robots"][0]["goal"]["service"].get<double>(), 2.0, 1e-6);
  Json returns = request;
  returns["robots"][0]["idle"] = "return";
  const Json done = advanced(returns, answer, 12.0);
  EXPECT_EQ(done["robots"][0]["goal"]["any_of"], docks(5)) << "it may come back to any of them";
  EXPECT_EQ(plan_of(done)["plans"][0]["actions"], Json::array()) << "and does not move for nothing";
}

TEST(OpenGoals, AreOpenAtTheHorizon) {
  Json request = dock_request({2.5, 1.5}, 5);
  request["options"]["horizon"] = 3.0;
  const Json answer = plan_of(request);
  EXPECT_TRUE(choice(answer, 0).is_null()) << answer.dump();
  EXPECT_TRUE(answer["plans"][0]["visits"][0]["t_arrive"].is_null());
  EXPECT_EQ(verdict_of(request, answer)["violations"], Json::array());
  Json now = advanced(request, answer, 3.0);
  EXPECT_TRUE(now["robots"][0]["goal"].contains("any_of"));
  for (int round = 0; round < 4; ++round) now = advanced(now, plan_of(now), 3.0);
  EXPECT_EQ(now["robots"][0]["goal"]["x"], 8.5) << "it has arrived";
}

TEST(OpenGoals, APoseThatAPlanTurnsInIsNotServedIfItSaysSo) {
  Json request = swap_request();
  request["robots"].erase(1);
  Json& robot = request["robots"][0];
  robot.erase("goal");
  robot["start"] = pose(0.5, 1.5);
  robot["goals"] = {{{"any_of", {pose(2.5, 1.5, 1.0), {{"x", 5.5}, {"y", 1.5}}}}, {"radius_after", 0.2}},
                    {{"x", 0.5}, {"y", 1.5}}};
  robot["goals"][0]["any_of"][0].erase("theta");
  const Json plan{{"robot", robot["id"]},
                  {"actions",
                   {action("translate", 0.0, 4.0, pose(0.5, 1.5), pose(2.5, 1.5)),
                    action("rotate", 4.0, 8.0, pose(2.5, 1.5), pose(2.5, 1.5, 1.0)),
                    action("wait", 8.0, 9.0, pose(2.5, 1.5, 1.0), pose(2.5, 1.5, 1.0))}},
                  {"visits",
                   {{{"goal", 0}, {"t_arrive", nullptr}, {"t_leave", nullptr}, {"choice", nullptr}},
                    {{"goal", 1}, {"t_arrive", nullptr}, {"t_leave", nullptr}}}}};
  const Json body{{"request", request}, {"plans", {plan}}, {"at", 5.0}, {"commit", 10.0}};
  const Reply reply = advance_endpoint(body.dump(), {});
  ASSERT_EQ(reply.status, 200) << reply.body;
  const Json next = json_of(reply)["robots"][0];
  EXPECT_EQ(next["goals"].size(), 2U) << next;
  EXPECT_EQ(next["goals"][0]["choice"], 1) << "nor do its actions serve it when they are read again";
  Json said = body;
  said["plans"][0]["visits"][0] = {{"goal", 0}, {"t_arrive", 4.0}, {"t_leave", 4.0}, {"choice", 0}};
  EXPECT_EQ(json_of(advance_endpoint(said.dump(), {}))["robots"][0]["goals"].size(), 1U);
}

TEST(OpenGoals, NewGoalsMayBeOpen) {
  const Json request = dock_request({2.5}, 5);
  const Json answer = plan_of(request);
  Json body{{"request", request}, {"plans", answer["plans"]}, {"at", 2.0}};
  const Json goal{{"any_of", docks(2)}, {"service", 1.0}};
  body["goals"].push_back({{"robot", "r0"}, {"goals", Json::array({goal})}});
  const Reply reply = advance_endpoint(body.dump(), {});
  ASSERT_EQ(reply.status, 200) << reply.body;
  const Json later = json_of(reply);
  EXPECT_EQ(later["robots"][0]["goal"]["any_of"], docks(2));
  EXPECT_EQ(choice(plan_of(later), 0), 1);
}

TEST(OpenGoals, APlanThatHoldsIsKept) {
  const Json request = dock_request({2.5, 1.5, 3.5, 0.5, 4.5}, 5);
  const Json answer = plan_of(request);
  const Json later = advanced(request, answer, 3.0);
  const Json planned = plan_of(later);
  for (std::size_t k = 0; k < 5; ++k) EXPECT_EQ(choice(planned, k), choice(answer, k));
}

class OneFaultOfOpenGoals : public testing::TestWithParam<FaultCase> {};

TEST_P(OneFaultOfOpenGoals, IsReportedAtItsPlace) { expect_one_fault(dock_request({2.5}, 5), GetParam()); }

Json& goal(Json& request) { return request["robots"][0]["goal"]; }

INSTANTIATE_TEST_SUITE_P(
    All, OneFaultOfOpenGoals,
    testing::Values(FaultCase{"NotAList", [](Json& r) { goal(r)["any_of"] = 1; }, "/robots/0/goal/any_of",
                              "wrong_type", "array"},
                    FaultCase{"One", [](Json& r) { goal(r)["any_of"] = docks(1); }, "/robots/0/goal/any_of",
                              "out_of_range", "a goal with one pose has it as x, y and theta"},
                    FaultCase{"TooMany", [](Json& r) { goal(r)["any_of"] = docks(101); },
                              "/robots/0/goal/any_of", "out_of_range", "2 to 100 poses, not 101"},
                    FaultCase{"APoseBesides", [](Json& r) { goal(r)["x"] = 1; }, "/robots/0/goal/x",
                              "duplicate", "either a pose or any_of"},
                    FaultCase{"NoY", [](Json& r) { goal(r)["any_of"][1].erase("y"); },
                              "/robots/0/goal/any_of/1/y", "missing", "y is missing"},
                    FaultCase{"NoSuchChoice", [](Json& r) { goal(r)["choice"] = 5; }, "/robots/0/goal/choice",
                              "out_of_range", "5 poses, numbered from 0"},
                    FaultCase{"ChoiceOfOnePose",
                              [](Json& r) {
                                goal(r) = pose(8.5, 2.5);
                                goal(r)["choice"] = 0;
                              },
                              "/robots/0/goal/choice", "out_of_range", "no any_of"},
                    FaultCase{"NegativeBias", [](Json& r) { goal(r)["any_of"][1]["bias"] = -1; },
                              "/robots/0/goal/any_of/1/bias", "out_of_range", "seconds"},
                    FaultCase{"ServiceOfAPose", [](Json& r) { goal(r)["any_of"][1]["service"] = 1; },
                              "/robots/0/goal/any_of/1/service", "unknown_key", "service"},
                    FaultCase{"AllInWalls",
                              [](Json& r) {
                                for (Json& row : r["map"]["rows"]) row = ".......###";
                              },
                              "/robots/0/goal/any_of", "goal_in_obstacle", "None of these poses fits"}),
    [](const auto& tested) { return tested.param.name; });

TEST(OpenGoals, AllInWallsMakeARobotInvalid) {
  Json request = dock_request({2.5, 0.5}, 5);
  for (Json& row : request["map"]["rows"]) row = ".......###";
  request["robots"][1]["goal"] = pose(4.5, 0.5);
  request["options"]["invalid_robots"] = "report";
  const Json answer = plan_of(request);
  ASSERT_EQ(answer["unplanned"].size(), 1U) << answer.dump();
  EXPECT_EQ(answer["unplanned"][0]["reason"], "invalid");
  EXPECT_EQ(answer["unplanned"][0]["errors"][0]["pointer"], "/robots/0/goal/any_of");
}

TEST(OpenGoals, AreReadBesideARobotThatCannotBeRead) {
  Json request = dock_request({0.5, 2.5}, 5);
  request["robots"][0]["radius"] = Json::array({0.3});
  const Reply reply = plan_endpoint(request.dump(), {});
  EXPECT_EQ(reply.status, 422);
  const Json errors = json_of(reply)["errors"];
  ASSERT_EQ(errors.size(), 1U) << reply.body;
  EXPECT_EQ(errors[0]["pointer"], "/robots/0/radius");
}

}  // namespace TEST_FILE
}  // namespace fleetplan::api
