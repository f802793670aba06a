#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "api/endpoints/endpoints.h"
#include "tests/api/support/answers.h"
#include "tests/api/support/motion_requests.h"
#include "tests/api/support/requests.h"
#include "tests/api/support/test_turn.h"

namespace fleetplan::api {
namespace TEST_FILE {

Json advance_request(const Json& request, double at) {
  return {{"request", request}, {"plans", plan_of(request)["plans"]}, {"at", at}};
}

Json advanced_json(const Json& body) {
  const Reply reply = advance_endpoint(body.dump(), {});
  EXPECT_EQ(reply.status, 200) << reply.body;
  return json_of(reply);
}

Faults faults_of_advance(const Json& body) {
  const Reply reply = advance_endpoint(body.dump(), {});
  EXPECT_EQ(reply.status, 422) << reply.body;
  return faults_in(reply);
}

TEST(AdvanceEndpoint, CopiesWhatTheMomentDoesNotChange) {
  Json request = swap_request();
  request["map"]["origin"] = {{"x", 0.1}, {"y", 0.2}};
  for (auto& robot : request["robots"]) robot["start"]["y"] = robot["goal"]["y"] = 1.7;
  request["options"] = {{"seed", 18446744073709551615U}, {"any_angle", true}, {"max_iterations", nullptr}};
  const Json next = advanced_json(advance_request(request, 1.0));
  for (const char* member : {"map", "robot_defaults", "options"}) EXPECT_EQ(next[member], request[member]);
  EXPECT_EQ(next["robots"][0]["id"], "a");
  EXPECT_EQ(next["robots"][1]["goal"], request["robots"][1]["goal"]);
}

TEST(AdvanceEndpoint, WritesTheRadiusThatALoadGivesARobot) {
  Json request = swap_request();
  const Json goal = request["robots"][0]["goal"];
  Json load = request["robots"][0]["start"];
  load["radius_after"] = 0.35;
  request["robots"][0].erase("goal");
  request["robots"][0]["goals"] = {load, goal};
  request["robots"][0]["goals"][1]["radius_after"] = 0.25;
  const Json next = advanced_json(advance_request(request, 0.5))["robots"];
  EXPECT_EQ(next[0]["radius"], 0.35);
  EXPECT_EQ(next[0]["goals"].size(), 1U);
  EXPECT_EQ(next[0]["goals"][0]["radius_after"], 0.25);
  EXPECT_EQ(next[1].contains("radius"), request["robots"][1].contains("radius"));
}

/// One robot that drives 1 m/s from x = 0.5 to 2.5, and on to 4.5.
Json driving_body() {
  Json request = swap_request();
  request["map"]["rows"] = {".........", ".........", "........."};
  request["robots"].erase(1);
  Json& robot = request["robots"][0];
  robot.erase("goal");
  robot["start"] = pose(0.5, 1.5);
  robot["goals"] = {{{"x", 2.5}, {"y", 1.5}}, {{"x", 4.5}, {"y", 1.5}}};
  const Json plan{{"robot", robot["id"]},
                  {"actions",
                   {action("translate", 0.0, 2.0, pose(0.5, 1.5), pose(2.5, 1.5)),
                    action("translate", 2.0, 4.0, pose(2.5, 1.5), pose(4.5, 1.5))}}};
  return {{"request", request}, {"plans", {plan}}, {"at", 1.0}, {"commit", 10.0}};
}

TEST(AdvanceEndpoint, ALoadThatARobotTakesWhereItIsHeldMayBeTooSlowForTheRestOfItsPlan) {
  Json body = driving_body();
  body["at"] = 2.0;
  body["request"]["robots"][0]["goals"][0] = {
      {"x", 2.5}, {"y", 1.5}, {"service", 5.0}, {"linear_speed_after", 0.5}};
  body["holds"].push_back({{"robot", "a"}, {"until", 8.0}});
  const Json next = advanced_json(body);
  EXPECT_FALSE(next["robots"][0].contains("previous")) << next;
  EXPECT_EQ(plan_of(next)["status"], "solved");
}

TEST(AdvanceEndpoint, CommitmentsEndWhereNewGoalsSlowARobotDown) {
  Json body = driving_body();
  body["goals"].push_back(
      {{"robot", "a"},
       {"goals", {{{"x", 2.5}, {"y", 1.5}, {"linear_speed_after", 0.5}}, {{"x", 0.5}, {"y", 1.5}}}}});
  const Json next = advanced_json(body);
  ASSERT_EQ(next["robots"][0]["committed"].size(), 1U) << next;
  EXPECT_EQ(next["robots"][0]["committed"][0]["to"]["x"], 2.5);
  EXPECT_EQ(plan_of(next)["status"], "solved");
}

TEST(AdvanceEndpoint, ARobotServesNothingBeforeItHasComeThereWhateverItReports) {
  Json body = driving_body();
  body["request"]["robots"][0]["goals"][0]["radius_after"] = 0.2;
  body["at"] = 2.0;
  body["states"].push_back({{"robot", "a"}, {"action", 0}, {"progress", 1.0}, {"x", 2.45}, {"y", 1.5}});
  const Json next = advanced_json(body);
  EXPECT_EQ(next["robots"][0]["goals"].size(), 2U) << next;
  EXPECT_EQ(next["robots"][0]["committed"][0]["to"]["x"], 2.5);
  EXPECT_EQ(plan_of(next)["status"], "solved");
}

TEST(AdvanceEndpoint, ADiskThatWouldBecomeLargerWhereItsCommitmentEndsStopsBeforeThat) {
  Json body = driving_body();
  body["request"]["robots"][0]["goals"][0]["radius_after"] = 0.45;
  body["request"]["robots"].push_back(
      {{"id", "b"}, {"radius", 0.3}, {"start", pose(2.5, 0.8)}, {"goal", pose(2.5, 0.8)}});
  body.erase("commit");
  const Json next = advanced_json(body);
  EXPECT_LT(next["robots"][0]["committed"].back()["to"]["x"].get<double>(), 2.5) << next;
  EXPECT_FALSE(next.contains("unavoidable"));
}

TEST(AdvanceEndpoint, KeepsTheNumbersOfThePlan) {
  Json request = swap_request();
  request["map"]["origin"] = {{"x", 0.1}, {"y", 0.2}};
  for (auto& robot : request["robots"]) robot["start"]["y"] = robot["goal"]["y"] = 1.7;
  const Json body = advance_request(request, 0.1);
  const Json robot = advanced_json(body)["robots"][0];
  const Json& actions = body["plans"][0]["actions"];
  EXPECT_EQ(robot["previous"].size(), actions.size());
  EXPECT_EQ(robot["previous"].back()["to"], actions.back()["to"]);
  EXPECT_EQ(robot["previous"][0]["from"], robot["start"]);
  EXPECT_EQ(robot["committed"][0], robot["previous"][0]);
}

TEST(AdvanceEndpoint, WithAHorizonItKeepsTheAgesOfGoals) {
  Json request = swap_request();
  request["options"] = {{"horizon", 100.0}};
  request["robots"][0]["goals"] = {{{"x", 0.5}, {"y", 3.5}, {"service", 1.0}},
                                   {{"x", 8.5}, {"y", 3.5}, {"not_before", 20.0}}};
  request["robots"][0].erase("goal");
  request["robots"][1]["goal_age"] = 5.0;
  const Json first = advance_request(request, 1.0);
  const Json plans = first["plans"];
  const auto ages = [&](double at, const Json& goals = Json::array()) {
    Json body = first;
    body["at"] = at;
    body["goals"] = goals;
    const Json next = advanced_json(body);
    return std::pair(next["robots"][0].value("goal_age", -1.0), next["robots"][1].value("goal_age", -1.0));
  };
  const double served = plans[0]["visits"][0]["t_leave"];
  EXPECT_LT(served, 10.0);
  EXPECT_EQ(ages(1.0), std::pair(1.0, 6.0));
  EXPECT_EQ(ages(served + 1.0).first, -1.0) << "the next goal is not due yet";
  EXPECT_EQ(ages(50.0).second, -1.0) << "it has arrived";
  const Json again{{{"robot", "b"}, {"goals", {{{"x", 1.5}, {"y", 1.5}}}}}};
  EXPECT_EQ(ages(1.0, again).second, -1.0) << "it has another goal";
  request.erase("options");
  EXPECT_FALSE(advanced_json(advance_request(request, 1.0))["robots"][1].contains("goal_age"));
}

TEST(AdvanceEndpoint, TakesItsTurnOnceItHasBeenRead) {
  TestTurn turn;
  RequestContext context;
  context.turn = &turn;
  Json body = advance_request(swap_request(), 1.0);
  EXPECT_EQ(advance_endpoint(body.dump(), context).status, 200);
  EXPECT_EQ(turn.requests, 1);
  EXPECT_EQ(turn.need->kind, TurnNeed::Kind::conversion);
  EXPECT_LE(turn.need->stop.deadline(), RequestContext::Clock::now() + std::chrono::seconds(5));
  turn.refuses = true;
  EXPECT_EQ(advance_endpoint(body.dump(), context).problem, "overloaded");
  body["at"] = -1.0;
  EXPECT_EQ(advance_endpoint(body.dump(), context).status, 422) << "its faults need no turn";
  EXPECT_EQ(turn.requests, 2);
}

TEST(AdvanceEndpoint, ReportsFaultsWhereTheyAre) {
  const Json good = advance_request(swap_request(), 1.0);
  const auto with = [&](const char* member, const char* value) {
    Json body = good;
    body[member] = Json::parse(value);
    return faults_of_advance(body);
  };
  EXPECT_EQ(with("at", "-1"), (Faults{{"/at", "out_of_range"}}));
  EXPECT_EQ(with("commit", "\"1\""), (Faults{{"/commit", "wrong_type"}}));
  EXPECT_EQ(with("pose_tolerance", "-0.1"), (Faults{{"/pose_tolerance", "out_of_range"}}));
  EXPECT_EQ(with("horizon", "1"), (Faults{{"/horizon", "unknown_key"}}));
  EXPECT_EQ(with("poses", R"([{"robot": "a", "x": 1, "y": 1}])"), (Faults{{"/poses/0/theta", "missing"}}));
  EXPECT_EQ(with("holds", R"([{"robot": "z", "until": 1}])"), (Faults{{"/holds/0/robot", "unknown_robot"}}));
  EXPECT_EQ(with("holds", R"([{"robot": "a", "until": 1}, {"robot": "a", "until": 2}])"),
            (Faults{{"/holds/1/robot", "duplicate"}}));
  EXPECT_EQ(with("goals", R"([{"robot": "a", "goals": [{"x": 1}]}])"),
            (Faults{{"/goals/0/goals/0/y", "missing"}}));
  EXPECT_EQ(with("plans", R"([{"robot": "a", "actions": [{"type": "fly"}]}])").front(),
            (std::pair<std::string, std::string>{"/plans/0/actions/0/type", "unknown_value"}));
}

TEST(AdvanceEndpoint, ReportsFaultsOfStatesWhereTheyAre) {
  const Json good = advance_request(swap_request(), 1.0);
  const auto with = [&](const char* states) {
    Json body = good;
    body["states"] = Json::parse(states);
    return faults_of_advance(body);
  };
  EXPECT_EQ(with("{}"), (Faults{{"/states", "wrong_type"}}));
  EXPECT_EQ(with(R"([{"robot": "a"}])"),
            (Faults{{"/states/0/action", "missing"}, {"/states/0/progress", "missing"}}));
  EXPECT_EQ(with(R"([{"robot": "z", "action": 0, "progress": 0}])"),
            (Faults{{"/states/0/robot", "unknown_robot"}}));
  EXPECT_EQ(with(R"([{"robot": "a", "action": 99, "progress": 0}])"),
            (Faults{{"/states/0/action", "out_of_range"}}));
  EXPECT_EQ(with(R"([{"robot": "a", "action": 0.5, "progress": 1.01}])"),
            (Faults{{"/states/0/action", "wrong_type"}, {"/states/0/progress", "out_of_range"}}));
  EXPECT_EQ(with(R"([{"robot": "a", "action": 0, "progress": -0.1}])"),
            (Faults{{"/states/0/progress", "out_of_range"}}));
  EXPECT_EQ(
      with(R"([{"robot": "a", "action": 0, "progress": 0}, {"robot": "a", "action": 0, "progress": 0}])"),
      (Faults{{"/states/1/robot", "duplicate"}}));
  EXPECT_EQ(with(R"([{"robot": "a", "action": 0, "progress": 0, "service_left": 1}])"),
            (Faults{{"/states/0/service_left", "unknown_key"}}));
  EXPECT_EQ(
      with(R"([{"robot": "a", "action": 0, "progress": 0.5, "released": {"action": 0, "progress": 0.25}}])"),
      (Faults{{"/states/0/released", "out_of_range"}}));
  EXPECT_EQ(with(R"([{"robot": "a", "action": 0, "progress": 0, "released": {"action": 99, "x": 1}}])"),
            (Faults{{"/states/0/released/action", "out_of_range"},
                    {"/states/0/released/x", "unknown_key"},
                    {"/states/0/released/progress", "missing"}}));
  EXPECT_EQ(with(R"([{"robot": "a", "action": 0, "progress": 0, "x": 1, "speed": 2000, "held_s": 1}])"),
            (Faults{{"/states/0/speed", "out_of_range"},
                    {"/states/0/held_s", "unknown_key"},
                    {"/states/0/y", "missing"}}));
}

TEST(AdvanceEndpoint, ARobotIsReportedOrMeasuredButNotBoth) {
  Json body = advance_request(swap_request(), 1.0);
  body["poses"] = Json::parse(R"([{"robot": "a", "x": 1, "y": 1, "theta": 0}])");
  body["states"] = Json::parse(R"([{"robot": "b", "action": 0, "progress": 0}])");
  EXPECT_EQ(advance_endpoint(body.dump(), {}).status, 200);
  body["states"][0]["robot"] = "a";
  EXPECT_EQ(faults_of_advance(body), (Faults{{"/states/0/robot", "duplicate"}}));
  body.erase("poses");
  body["plans"] = Json::array();
  EXPECT_EQ(faults_of_advance(body), (Faults{{"/states/0/action", "out_of_range"}}));
  EXPECT_NE(advance_endpoint(body.dump(), {}).body.find("leave its state out"), std::string::npos);
}

/// A robot that is served for ten seconds at its first goal, from 5 s on, but has come there late.
Json late_service() {
  return Json::parse(R"({
    "request": {
      "map": {"rows": ["........", "........", "........", "........", "........"]},
      "robot_defaults": {"radius": 0.3, "linear_speed": 1.0, "angular_speed": 1.0},
      "robots": [{"id": "a", "start": {"x": 1.25, "y": 1.25},
                  "goals": [{"x": 6.25, "y": 1.25, "service": 10}, {"x": 6.25, "y": 4.25}]}]},
    "plans": [{"robot": "a", "actions": [
      {"type": "translate", "t_start": 0, "t_end": 5,
       "from": {"x": 1.25, "y": 1.25, "theta": 0}, "to": {"x": 6.25, "y": 1.25, "theta": 0}},
      {"type": "wait", "t_start": 5, "t_end": 15, "goal": 0,
       "from": {"x": 6.25, "y": 1.25, "theta": 0}, "to": {"x": 6.25, "y": 1.25, "theta": 0}},
      {"type": "rotate", "t_start": 15, "t_end": 16.5707963267949,
       "from": {"x": 6.25, "y": 1.25, "theta": 0}, "to": {"x": 6.25, "y": 1.25, "theta": 1.5707963267948966}},
      {"type": "translate", "t_start": 16.5707963267949, "t_end": 19.5707963267949,
       "from": {"x": 6.25, "y": 1.25, "theta": 1.5707963267948966},
       "to": {"x": 6.25, "y": 4.25, "theta": 1.5707963267948966}}]}],
    "at": 18, "commit": 2})");
}

TEST(AdvanceEndpoint, ALateServiceIsNotLost) {
  Json body = late_service();
  body["states"] = Json::parse(
      R"([{"robot": "a", "action": 1, "progress": 0.3, "x": 6.25, "y": 1.25, "theta": 0, "speed": 0}])");
  const Json next = advanced_json(body);
  const Json& robot = next["robots"][0];
  ASSERT_EQ(robot["goals"].size(), 2U);
  EXPECT_EQ(robot["goals"][0]["service"], 7.0);
  EXPECT_EQ(robot["committed"].back()["t_end"], 2.0);
  const Json plan = plan_of(next)["plans"][0];
  EXPECT_EQ(plan["visits"][0]["t_leave"], 7.0);
  EXPECT_EQ(nlohmann::json(plan["actions"]), nlohmann::json(robot["previous"])) << "in whatever order";
  EXPECT_EQ(next["progress"], Json::parse(R"([{"robot": "a", "was": {"action": 1, "progress": 0.3},
                                               "is": {"action": 0, "progress": 0.0}}])"));
}

TEST(AdvanceEndpoint, TheProgressOfAnAnswerIsIgnoredByAllThatTakeARequest) {
  Json next = advanced_json(advance_request(swap_request(), 1.0));
  ASSERT_EQ(next["progress"].size(), 2U);
  const Json answer = plan_of(next);
  for (const Json& progress : {next["progress"], Json("of an earlier moment")}) {
    next["progress"] = progress;
    Json again = advanced_json({{"request", next}, {"plans", answer["plans"]}, {"at", 0.5}});
    EXPECT_EQ(again["progress"].size(), 2U);
    Json check = next;
    check["plans"] = answer["plans"];
    EXPECT_EQ(validate_endpoint(check.dump(), {}).status, 200);
    EXPECT_EQ(dependencies_endpoint(check.dump(), {}).status, 200);
    check["policy"] = "absorb_waits";
    EXPECT_EQ(simulate_endpoint(check.dump(), {}).status, 200);
  }
}

TEST(AdvanceEndpoint, ReportsFaultsOfTheRequestBelowIt) {
  Json body = advance_request(swap_request(), 1.0);
  body["request"]["robots"][1]["start"]["x"] = "left";
  body["request"]["robot"] = 1;
  EXPECT_EQ(faults_of_advance(body),
            (Faults{{"/request/robots/1/start/x", "wrong_type"}, {"/request/robot", "unknown_key"}}));
  EXPECT_EQ(faults_of_advance(Json::object()),
            (Faults{{"/request", "missing"}, {"/at", "missing"}, {"/plans", "missing"}}));
  EXPECT_EQ(faults_of_advance(Json::array({1})), (Faults{{"", "wrong_type"}}));
  body["request"] = 1;
  EXPECT_EQ(faults_of_advance(body).front().first, "/request");
}

TEST(AdvanceEndpoint, ARequestThatNeedsTooMuchMemoryIsRefused) {
  RequestContext context;
  context.limits.max_plan_memory = 4 << 20;
  Json body = advance_request(swap_request(), 1.0);
  const Json action = body["plans"][0]["actions"][0];
  for (int k = 0; k < 20'000; ++k) body["plans"][0]["actions"].push_back(action);
  const Reply reply = advance_endpoint(body.dump(), context);
  EXPECT_EQ(json_of(reply)["code"], "memory_exceeded");
}

/// Two robots that pass each other in a hall with a pillar, later.
Json passing(double at) {
  const Json request = Json::parse(R"({
    "map": {"rows": ["..........", "..........", ".....#....", ".........."]},
    "robot_defaults": {"radius": 0.3, "linear_speed": 1.0, "angular_speed": 3.0},
    "robots": [{"id": "a", "start": {"x": 0.5, "y": 2.5, "theta": 0}, "goal": {"x": 9.5, "y": 2.5}},
               {"id": "b", "start": {"x": 9.5, "y": 3.5, "theta": 3.141592653589793},
                "goal": {"x": 0.5, "y": 3.5}}],
    "options": {"inflation": 0.05}})");
  return advance_request(request, at);
}

TEST(AdvanceEndpoint, RobotsThatAreMeasuredInEachOtherAreNamedAndMayPart) {
  Json body = passing(4.5);
  body["poses"] = Json::parse(R"([{"robot": "a", "x": 4.9, "y": 2.8, "theta": 0},
                                  {"robot": "b", "x": 5.0, "y": 3.3, "theta": 3.14}])");
  const Json next = advanced_json(body);
  EXPECT_EQ(next["unavoidable"], Json::parse(R"([{"robots": ["a", "b"], "t": 0.0}])"));
  EXPECT_EQ(next["unavoidable_total"], 1);
  const double overlap = 0.6 - std::hypot(0.1, 0.5);
  EXPECT_NEAR(next["options"]["start_overlap"].get<double>(), overlap + 0.1, 1e-9);
  EXPECT_EQ(next["options"]["inflation"], 0.05);
  EXPECT_EQ(plan_of(next)["status"], "solved");
  body["request"]["options"]["start_overlap"] = 0.5;
  EXPECT_EQ(advanced_json(body)["options"]["start_overlap"], 0.5);
  body["poses"] = Json::parse(R"([{"robot": "a", "x": 4.9, "y": 2.5, "theta": 0}])");
  EXPECT_FALSE(advanced_json(body).contains("unavoidable"));
  EXPECT_FALSE(advanced_json(body).contains("unavoidable_total"));
}

TEST(AdvanceEndpoint, PairsThatOverlapAreCountedAndTheFirstOfThemListed) {
  constexpr std::size_t kRobots = 150;
  constexpr std::size_t kPairs = kRobots * (kRobots - 1) / 2;
  constexpr std::size_t kMaxListed = 10'000;
  Json body = Json::parse(R"({"request": {"map": {"rows": []}, "robots": [],
    "robot_defaults": {"radius": 0.3, "linear_speed": 1.0, "angular_speed": 3.0}}, "plans": [], "at": 1})");
  for (std::size_t k = 0; k < kRobots; ++k) {
    const std::string id = std::to_string(k);
    body["request"]["map"]["rows"].push_back("...");
    const double y = 0.5 + static_cast<double>(k);
    body["request"]["robots"].push_back({{"id", id}, {"start", {{"x", 1.5}, {"y", y}}}});
    body["poses"].push_back({{"robot", id}, {"x", 1.5}, {"y", 1.5}, {"theta", 0.0}});
  }
  const Json next = advanced_json(body);
  EXPECT_EQ(next["unavoidable"].size(), kMaxListed);
  EXPECT_EQ(next["unavoidable_total"], kPairs);
  body["poses"].erase(body["poses"].begin(), body["poses"].end() - 2);
  body["request"]["unavoidable_total"] = kPairs;  // of an answer before, which is the next request
  EXPECT_EQ(advanced_json(body)["unavoidable_total"], 3) << "two, and the one that stands there";
}

TEST(AdvanceEndpoint, ARobotThatWouldDriveIntoAWallIsNotCommittedToIt) {
  Json body = passing(3.0);
  body["pose_tolerance"] = 0.3;
  body["poses"] = Json::parse(R"([{"robot": "a", "x": 3.5, "y": 2.21, "theta": 0}])");  // towards the pillar
  const Json next = advanced_json(body);
  EXPECT_FALSE(next["robots"][0].contains("committed")) << next;
  EXPECT_TRUE(next["robots"][1].contains("committed"));
  EXPECT_FALSE(next["options"].contains("start_overlap"));
  EXPECT_EQ(plan_of(next)["status"], "solved");
}

TEST(AdvanceEndpoint, ARobotThatIsMeasuredInAWallIsAccepted) {
  Json body = passing(3.0);
  body["poses"] = Json::parse(R"([{"robot": "a", "x": 5.2, "y": 2.1, "theta": 0}])");
  const Json beside = advanced_json(body);
  EXPECT_NEAR(beside["options"]["start_overlap"].get<double>(), 0.25, 1e-6);
  plan_of(beside);
  body["poses"][0]["y"] = 1.5;
  const Json inside = advanced_json(body);
  EXPECT_EQ(inside["options"]["invalid_robots"], "report");
  EXPECT_EQ(plan_of(inside)["unplanned"][0]["reason"], "invalid");
}

/// Whether disks overlap by more than contact, if robots execute their commitments and then stand.
bool meet(const Json& request, std::size_t first, std::size_t second) {
  const auto position = [&](std::size_t robot, double t) {
    const Json& one = request["robots"][robot];
    std::array<double, 2> at{one["start"]["x"], one["start"]["y"]};
    for (const Json& action : one.value("committed", Json::array())) {
      const double begin = action["t_start"];
      const double end = action["t_end"];
      if (t <= begin) break;
      const double share = std::min(1.0, (t - begin) / (end - begin));
      const auto between = [&](const char* axis) {
        const double from = action["from"][axis];
        return from + share * (action["to"][axis].get<double>() - from);
      };
      at = {between("x"), between("y")};
    }
    return at;
  };
  const double reach =
      request["robots"][first]["radius"].get<double>() + request["robots"][second]["radius"].get<double>();
  for (int step = 0; step < 2000; ++step) {
    const auto a = position(first, 0.005 * step);
    const auto b = position(second, 0.005 * step);
    if (std::hypot(a[0] - b[0], a[1] - b[1]) < reach - 1e-6) return true;
  }
  return false;
}

/// Three robots on an open field, two of them measured, that are committed for four seconds.
TEST(AdvanceEndpoint, CommitmentsNeverMeet) {
  Json body = Json::parse(R"({
    "request": {
      "map": {"resolution": 0.5},
      "robots": [
        {"id": "a", "radius": 0.35, "linear_speed": 2.0, "angular_speed": 1.5,
         "start": {"x": 2, "y": 8.40430808042056, "theta": 0}, "goal": {"x": 14, "y": 8.99983713196635}},
        {"id": "b", "radius": 0.25, "linear_speed": 2.0, "angular_speed": 1.5,
         "start": {"x": 7.2669981053243955, "y": 2, "theta": 1.5707963267948966},
         "goal": {"x": 10.859688605502331, "y": 14}},
        {"id": "c", "radius": 0.5, "linear_speed": 1.5, "angular_speed": 1.5,
         "start": {"x": 14, "y": 9.941593788527909, "theta": 3.141592653589793},
         "goal": {"x": 2, "y": 9.187893222363368}}],
      "options": {"inflation": 0.05}},
    "plans": [
      {"robot": "a", "actions": [
        {"type": "rotate", "t_start": 0.0, "t_end": 0.033057825946450396,
         "from": {"x": 2.0, "y": 8.40430808042056, "theta": 0.0},
         "to": {"x": 2.0, "y": 8.40430808042056, "theta": 0.0495867389196756}},
        {"type": "translate", "t_start": 0.033057825946450396, "t_end": 6.040441924937355,
         "from": {"x": 2.0, "y": 8.40430808042056, "theta": 0.0495867389196756},
         "to": {"x": 14.0, "y": 8.99983713196635, "theta": 0.0495867389196756}}]},
      {"robot": "b", "actions": [
        {"type": "rotate", "t_start": 0.0, "t_end": 0.1939319137142371,
         "from": {"x": 7.2669981053243955, "y": 2.0, "theta": 1.5707963267948966},
         "to": {"x": 7.2669981053243955, "y": 2.0, "theta": 1.279898456223541}},
        {"type": "wait", "t_start": 0.1939319137142371, "t_end": 0.5809972639248697,
         "from": {"x": 7.2669981053243955, "y": 2.0, "theta": 1.279898456223541},
         "to": {"x": 7.2669981053243955, "y": 2.0, "theta": 1.279898456223541}},
        {"type": "translate", "t_start": 0.5809972639248697, "t_end": 6.84413196290087,
         "from": {"x": 7.2669981053243955, "y": 2.0, "theta": 1.279898456223541},
         "to": {"x": 10.859688605502331, "y": 14.0, "theta": 1.279898456223541}}]},
      {"robot": "c", "actions": [
        {"type": "rotate", "t_start": 0.0, "t_end": 0.030033593002088448,
         "from": {"x": 14.0, "y": 9.941593788527909, "theta": 3.141592653589793},
         "to": {"x": 14.0, "y": 9.941593788527909, "theta": -3.0965422640866604}},
        {"type": "translate", "t_start": 0.030033593002088448, "t_end": 2.8662445379701555,
         "from": {"x": 14.0, "y": 9.941593788527909, "theta": -3.0965422640866604},
         "to": {"x": 9.75, "y": 9.75, "theta": -3.0965422640866604}},
        {"type": "rotate", "t_start": 2.8662445379701555, "t_end": 2.8844796939152575,
         "from": {"x": 9.75, "y": 9.75, "theta": -3.0965422640866604},
         "to": {"x": 9.75, "y": 9.75, "theta": -3.0691895301690075}},
        {"type": "wait", "t_start": 2.8844796939152575, "t_end": 3.4328634320245985,
         "from": {"x": 9.75, "y": 9.75, "theta": -3.0691895301690075},
         "to": {"x": 9.75, "y": 9.75, "theta": -3.0691895301690075}},
        {"type": "translate", "t_start": 3.4328634320245985, "t_end": 8.613102123627955,
         "from": {"x": 9.75, "y": 9.75, "theta": -3.0691895301690075},
         "to": {"x": 2.0, "y": 9.187893222363368, "theta": -3.0691895301690075}}]}],
    "at": 2.2182072063085205, "commit": 4,
    "poses": [
      {"robot": "a", "x": 4.458418077123165, "y": 8.526313029234908, "theta": 0.0495867389196756},
      {"robot": "c", "x": 12.189645484926066, "y": 9.859981393205175, "theta": -3.0965422640866604}]})");
  body["request"]["map"]["rows"] = std::vector<std::string>(32, std::string(32, '.'));
  const Json next = advanced_json(body);
  for (const auto& [a, b] : {std::pair{0U, 1U}, std::pair{0U, 2U}, std::pair{1U, 2U}}) {
    EXPECT_FALSE(meet(next, a, b)) << a << " and " << b << ": " << next;
  }
  EXPECT_FALSE(plan_of(next).contains("unavoidable"));
}

/// A robot drives along a corridor with a zone in it, and is measured in the zone.
Json measured_in(const Json& zone, const Json& pose) {
  Json request = Json::parse(R"({
    "map": {"rows": ["........", "........", "........"], "origin": {"x": 10, "y": 0}},
    "robot_defaults": {"radius": 0.3, "linear_speed": 1.0, "angular_speed": 3.0},
    "robots": [{"id": "a", "start": {"x": 10.5, "y": 1.5}, "goal": {"x": 17.5, "y": 1.5}}]})");
  request["zones"] = Json::array({zone});
  request["zones"][0]["polygon"] =
      Json::parse(R"([{"x": 12, "y": 0}, {"x": 14, "y": 0}, {"x": 14, "y": 3}, {"x": 12, "y": 3}])");
  Json body = advance_request(request, 5.9);
  body["poses"] = Json::array({pose});
  return advanced_json(body);
}

TEST(AdvanceEndpoint, NoCommitmentOfAMeasuredRobotBreaksTheRuleOfAZone) {
  const Json slow{{"id", "slow"}, {"type", "speed"}, {"linear_speed", 0.5}};
  const Json one_way{{"id", "one"}, {"type", "one_way"}, {"heading", 0.0}, {"half_angle", 0.001}};
  for (const Json& next :
       {measured_in(slow, {{"robot", "a"}, {"x", 13.95}, {"y", 1.5}, {"theta", 0.0}}),
        measured_in(one_way, {{"robot", "a"}, {"x", 13.0}, {"y", 1.55}, {"theta", 0.0}})}) {
    EXPECT_FALSE(next["robots"][0].contains("committed")) << next;
    EXPECT_EQ(plan_endpoint(next.dump(), {}).status, 200);
  }
  const Json slower = measured_in(slow, {{"robot", "a"}, {"x", 13.0}, {"y", 1.5}, {"theta", 0.0}});
  EXPECT_TRUE(slower["robots"][0].contains("committed")) << slower;
}

}  // namespace TEST_FILE
}  // namespace fleetplan::api
