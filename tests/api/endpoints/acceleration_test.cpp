// Robots with limited acceleration, at the endpoints. Their plans have profiles, which are checked and
// accepted as commitments. They end at rest where /v1/advance cuts them.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "api/endpoints/endpoints.h"
#include "tests/api/support/answers.h"
#include "tests/api/support/requests.h"

namespace fleetplan::api {
namespace TEST_FILE {

/// Two robots swap the ends of a hall; they reach 1 m/s after half a metre.
Json request_with_inertia() {
  Json request = swap_request();
  request["robot_defaults"]["linear_acceleration"] = 1.0;
  request["robot_defaults"]["angular_acceleration"] = 4.0;
  return request;
}

Json verdict_on(const Json& request, const Json& plans) {
  return verdict_of(request, Json::object({{"plans", plans}}));
}

/// A corridor, 20 m long, with one robot that drives along it: 2 m/s after 2 m, and 4 m to stop.
Json corridor() {
  return Json::parse(R"({
    "map": {"rows": ["....................", "...................."]},
    "robots": [{"id": "a", "radius": 0.4, "linear_speed": 2.0, "angular_speed": 2.0, "linear_acceleration": 1.0,
                "linear_deceleration": 0.5, "start": {"x": 0.5, "y": 0.5}, "goal": {"x": 18.5, "y": 0.5}}]})");
}

TEST(Accelerations, MakeProfilesOfEveryMove) {
  const Json answer = plan_of(corridor());
  const Json& actions = answer["plans"][0]["actions"];
  ASSERT_EQ(actions.size(), 1U);
  EXPECT_EQ(actions[0]["profile"], Json({{"start", 0.0}, {"cruise", 2.0}, {"end", 0.0}}));
  // 18 m at 2 m/s, and half of the 2 s and 4 s in which it starts and stops.
  EXPECT_NEAR(actions[0]["t_end"], 9.0 + 1.0 + 2.0, 1e-12);
  EXPECT_EQ(answer["lower_bound"]["flowtime"], answer["flowtime"]);
}

TEST(Accelerations, OfDefaultsAreThoseOfRobots) {
  const Json answer = plan_of(request_with_inertia());
  EXPECT_EQ(answer["status"], "solved");
  EXPECT_EQ(answer["verified"], true);
  for (const Json& plan : answer["plans"]) {
    for (const Json& action : plan["actions"])
      EXPECT_EQ(action.contains("profile"), action["type"] != "wait");
  }
}

TEST(Accelerations, MakeNoDifferenceWhenTheyAreMissing) {
  const Json without = plan_of(swap_request());
  for (const Json& plan : without["plans"]) {
    for (const Json& action : plan["actions"]) EXPECT_FALSE(action.contains("profile"));
  }
}

TEST(Accelerations, AreFaultsOutsideOfTheirRanges) {
  Json request = swap_request();
  request["robot_defaults"]["linear_acceleration"] = 0.0;
  request["robots"][0]["linear_deceleration"] = -1.0;
  request["robots"][1]["angular_acceleration"] = 1e7;
  EXPECT_EQ(brief_faults_of(request), (Faults{{"/robot_defaults/linear_acceleration", "out_of_range"},
                                              {"/robots/0/linear_deceleration", "out_of_range"},
                                              {"/robots/1/angular_acceleration", "out_of_range"}}));
}

/// The robot picks a load up at the end of the corridor, and takes it back, backwards. It is at 0.5 m/s after
/// 0.5 m, and stops in as much.
Json haul() {
  Json request = corridor();
  Json& robot = request["robots"][0];
  robot["may_reverse"] = true;
  robot.erase("goal");
  robot["goals"] = Json::parse(R"([
    {"x": 18.5, "y": 0.5, "service": 2, "linear_speed_after": 0.5, "linear_acceleration_after": 0.25},
    {"x": 0.5, "y": 0.5}])");
  return request;
}

TEST(LoadedRobots, DriveAsTheirLoadsAllow) {
  const Json answer = plan_of(haul());
  const Json& actions = answer["plans"][0]["actions"];
  ASSERT_EQ(actions.size(), 3U);
  EXPECT_EQ(actions[0]["profile"]["cruise"], 2.0);
  EXPECT_EQ(actions[2]["profile"]["cruise"], 0.5);
  // 12 s there, the service, and 18 m at 0.5 m/s. Starting and stopping take 2 s each, half of it in
  // addition.
  EXPECT_NEAR(actions[2]["t_end"], 12.0 + 2.0 + 36.0 + 1.0 + 1.0, 1e-9);
  EXPECT_EQ(answer["lower_bound"]["flowtime"], answer["flowtime"]);
  EXPECT_EQ(answer["verified"], true);
  ASSERT_EQ(answer["plans"][0]["visits"].size(), 2U);
  Json brakes_longer = haul();
  brakes_longer["robots"][0]["goals"][0]["linear_deceleration_after"] = 0.125;
  EXPECT_NEAR(plan_of(brakes_longer)["flowtime"], 53.0, 1e-9);
}

TEST(LoadedRobots, AreSlowWithoutAccelerationsToo) {
  Json request = haul();
  for (const char* member : {"linear_acceleration", "linear_deceleration"})
    request["robots"][0].erase(member);
  request["robots"][0]["goals"][0].erase("linear_acceleration_after");
  EXPECT_NEAR(plan_of(request)["flowtime"], 9.0 + 2.0 + 36.0, 1e-9);
}

TEST(LoadedRobots, NeedNotSlowDownInZonesThatAreFasterThanThey) {
  Json request = haul();
  request["zones"] = Json::parse(R"([{"id": "bay", "type": "speed", "linear_speed": 1,
    "polygon": [{"x": 8.5, "y": 0}, {"x": 10.5, "y": 0}, {"x": 10.5, "y": 2}, {"x": 8.5, "y": 2}]}])");
  const Json answer = plan_of(request);
  EXPECT_EQ(answer["verified"], true);
  const Json& actions = answer["plans"][0]["actions"];
  ASSERT_EQ(actions.size(), 5U);
  EXPECT_EQ(actions[1]["profile"]["cruise"], 1.0);
  EXPECT_EQ(actions[4]["profile"]["cruise"], 0.5);
  EXPECT_EQ(verdict_on(request, answer["plans"])["valid"], true);
}

TEST(LoadedRobots, AreCheckedWithTheirLoads) {
  Json without = haul();
  for (const char* member : {"linear_speed_after", "linear_acceleration_after"})
    without["robots"][0]["goals"][0].erase(member);
  const Json plans = plan_of(without)["plans"];
  EXPECT_EQ(verdict_on(without, plans)["valid"], true);
  const auto kinds_of = [](const Json& verdict) {
    std::vector<std::string> kinds;
    for (const Json& violation : verdict["violations"]) kinds.push_back(violation["kind"]);
    return kinds;
  };
  EXPECT_THAT(kinds_of(verdict_on(haul(), plans)), testing::Contains("speed"));
  Json slow = haul();
  slow["robots"][0]["goals"][0].erase("linear_speed_after");
  EXPECT_THAT(kinds_of(verdict_on(slow, plans)), testing::ElementsAre("profile")) << "other accelerations";
}

TEST(LoadedRobots, KeepTheirLoadsLater) {
  const Json request = haul();
  const Json plan = plan_of(request);
  const Json before = advanced(request, plan, 5.0)["robots"][0];
  EXPECT_EQ(before["linear_speed"], 2.0);
  EXPECT_EQ(before["goals"], request["robots"][0]["goals"]);
  const Json next = advanced(request, plan, 20.0);
  const Json& loaded = next["robots"][0];
  EXPECT_EQ(loaded["linear_speed"], 0.5);
  EXPECT_EQ(loaded["linear_acceleration"], 0.25);
  EXPECT_EQ(loaded["linear_deceleration"], 0.25);
  EXPECT_EQ(loaded["goals"], Json::array({request["robots"][0]["goals"][1]}));
  EXPECT_EQ(loaded["start"]["speed"], -0.5);
  EXPECT_NEAR(plan_of(next)["flowtime"], 32.0, 1e-9);
}

TEST(LoadedRobots, ArePlannedAheadOfTheirLoads) {
  for (const bool is_open : {false, true}) {
    Json request = haul();
    if (is_open) {
      Json& goal = request["robots"][0]["goals"][0];
      goal["any_of"] = Json::parse(R"([{"x": 15.5, "y": 1.5, "bias": 100}, {"x": 18.5, "y": 0.5}])");
      goal.erase("x");
      goal.erase("y");
    }
    const Json plan = plan_of(request);
    ASSERT_NEAR(plan["flowtime"], 52.0, 1e-9);
    Json next = advanced(request, plan, 5.0, {{"commit", 30.0}});
    EXPECT_EQ(next["robots"][0]["committed"].size(), 3U) << "into the way with the load";
    EXPECT_EQ(plan_of(next)["status"], "solved");
    Json body = request;
    body["plans"] = plan["plans"];
    body["policy"] = "open_loop";
    body["runs"] = 1;
    EXPECT_NEAR(answer_of(simulate_endpoint, body)["flowtime"]["mean"], 52.0, 1e-6);
  }
}

TEST(LoadedRobots, HaveAccelerationsOnlyIfTheyAreLimited) {
  Json request = haul();
  for (const char* member : {"linear_acceleration", "linear_deceleration"})
    request["robots"][0].erase(member);
  EXPECT_EQ(brief_faults_of(request),
            (Faults{{"/robots/0/goals/0/linear_acceleration_after", "out_of_range"}}));
  Json wrong = haul();
  wrong["robots"][0]["goals"][0]["linear_speed_after"] = 0.0;
  wrong["robots"][0]["goals"][0]["linear_acceleration_after"] = "slow";
  wrong["robots"][0]["goals"][1]["linear_deceleration_after"] = -1;
  EXPECT_EQ(brief_faults_of(wrong),
            (Faults{{"/robots/0/goals/0/linear_speed_after", "out_of_range"},
                    {"/robots/0/goals/0/linear_acceleration_after", "wrong_type"},
                    {"/robots/0/goals/1/linear_deceleration_after", "out_of_range"}}));
}

TEST(LoadedRobots, GetNewGoalsOnTheSameTerms) {
  Json request = haul();
  const Json plan = plan_of(request);
  const Json goals = Json::array({{{"robot", "a"}, {"goals", request["robots"][0]["goals"]}}});
  EXPECT_EQ(advanced(request, plan, 20.0, {{"goals", goals}})["robots"][0]["linear_speed"], 0.5);
}

TEST(Profiles, ThatDoNotFitAreViolations) {
  const Json request = request_with_inertia();
  const Json answer = plan_of(request);
  ASSERT_EQ(verdict_on(request, answer["plans"])["valid"], true);
  const auto kinds_with = [&](const auto& change) {
    Json plans = answer["plans"];
    for (Json& action : plans[0]["actions"]) {
      if (action["type"] != "translate") continue;
      change(action);
      break;
    }
    std::vector<std::string> kinds;
    const Json verdict = verdict_on(request, plans);
    for (const Json& violation : verdict["violations"]) kinds.push_back(violation["kind"]);
    return kinds;
  };
  using testing::Contains;
  EXPECT_THAT(kinds_with([](Json& action) { action.erase("profile"); }), Contains("profile"));
  EXPECT_THAT(kinds_with([](Json& action) {
                action["profile"]["cruise"] = 0.9 * action["profile"]["cruise"].template get<double>();
              }),
              Contains("profile"))
      << "covers less";
  EXPECT_THAT(kinds_with([](Json& action) { action["profile"]["cruise"] = 3.0; }), Contains("profile"))
      << "faster than the robot";
  EXPECT_THAT(kinds_with([](Json& action) { action["profile"]["start"] = 0.1; }), Contains("profile"))
      << "does not begin at rest";
  EXPECT_THAT(kinds_with([](Json& action) { action["profile"]["end"] = 0.1; }), Contains("profile"))
      << "does not end at rest";
}

TEST(Profiles, OfCommitmentsAreKept) {
  Json request = request_with_inertia();
  const Json answer = plan_of(request);
  for (std::size_t k = 0; k < 2; ++k) request["robots"][k]["committed"] = answer["plans"][k]["actions"];
  const Json again = plan_of(request);
  EXPECT_EQ(again["status"], "solved");
  for (std::size_t k = 0; k < 2; ++k) EXPECT_EQ(again["plans"][k]["actions"], answer["plans"][k]["actions"]);
}

TEST(Profiles, OfCommitmentsThatDoNotFitAreFaults) {
  Json request = corridor();
  request["robots"][0]["committed"] = plan_of(request)["plans"][0]["actions"];
  Json& action = request["robots"][0]["committed"][0];
  const Json profile = action["profile"];
  const std::string place = "/robots/0/committed/0/profile";
  action["profile"]["cruise"] = 1.5;
  EXPECT_EQ(brief_faults_of(request), (Faults{{place, "profile"}})) << "covers less";
  action["profile"]["cruise"] = 2.5;
  EXPECT_EQ(brief_faults_of(request), (Faults{{place, "profile"}})) << "faster than the robot";
  action["profile"] = {{"start", 0.0}, {"cruise", 0.0}, {"end", 0.0}};
  EXPECT_EQ(brief_faults_of(request), (Faults{{place, "profile"}})) << "stands";
  action["profile"] = {{"start", 0.0}, {"cruise", 2.0}};
  EXPECT_EQ(brief_faults_of(request), (Faults{{place + "/end", "missing"}}));
  action["profile"] = profile;
  action["t_end"] = action["t_end"].get<double>() - 2.0;
  action["profile"]["end"] = 1.0;
  action["to"]["x"] = action["to"]["x"].get<double>() - 1.0;
  EXPECT_EQ(brief_faults_of(request), (Faults{{"/robots/0/committed", "profile"}})) << "ends at a speed";
  action.erase("profile");
  EXPECT_EQ(brief_faults_of(request), Faults{}) << "measured";
}

TEST(Profiles, OfWaitsAreFaults) {
  Json request = corridor();
  request["robots"][0]["committed"] = Json::array({{{"type", "wait"},
                                                    {"t_start", 0},
                                                    {"t_end", 1},
                                                    {"from", {{"x", 0.5}, {"y", 0.5}, {"theta", 0}}},
                                                    {"to", {{"x", 0.5}, {"y", 0.5}, {"theta", 0}}},
                                                    {"profile", {{"start", 0}, {"cruise", 1}, {"end", 0}}}}});
  EXPECT_EQ(brief_faults_of(request), (Faults{{"/robots/0/committed/0/profile", "unknown_key"}}));
}

TEST(Advance, CommitsARobotUntilItCanStand) {
  const Json request = corridor();
  const Json answer = plan_of(request);
  // At 5 s it is at 8.5 m and drives at 2 m/s. It begins to brake 1 s later, for 4 s.
  const Json next = advanced(request, answer, 5.0, {{"commit", 1.0}});
  const Json& robot = next["robots"][0];
  EXPECT_NEAR(robot["start"]["x"], 0.5 + 8.0, 1e-9);
  ASSERT_EQ(robot["committed"].size(), 1U);
  const Json& action = robot["committed"][0];
  EXPECT_NEAR(action["t_end"], 1.0 + 4.0, 1e-9);
  EXPECT_NEAR(action["to"]["x"], 8.5 + 2.0 + 4.0, 1e-9);
  EXPECT_EQ(action["profile"], Json({{"start", 2.0}, {"cruise", 2.0}, {"end", 0.0}}));
  const Json again = plan_of(next);
  EXPECT_EQ(again["status"], "solved");
  EXPECT_EQ(again["verified"], true);
}

/// The request with its plans and dependencies.
Json with_dependencies(Json request) {
  request["options"] = {{"dependencies", true}, {"interval_margin", 1.0}};
  const Json answer = plan_of(request);
  EXPECT_TRUE(answer["tight"].empty());
  request["plans"] = answer["plans"];
  request["dependencies"] = answer["dependencies"];
  request.erase("options");
  return request;
}

TEST(Simulation, FollowsProfiles) {
  Json plain = request_with_inertia();
  plain["tolerance"] = 1e-5;  // dependencies use the tolerance of the plan
  Json request = with_dependencies(request_with_inertia());
  request["runs"] = 5;
  request["trace"] = 3;
  for (const char* policy : {"open_loop", "absorb_waits", "dependencies"}) {
    request["policy"] = policy;
    const Json undisturbed = answer_of(simulate_endpoint, request);
    EXPECT_TRUE(undisturbed["warnings"].empty()) << undisturbed["warnings"];
    EXPECT_EQ(undisturbed["collision_share"], 0.0);
    EXPECT_EQ(verdict_on(plain, undisturbed["trace"]["plans"])["valid"], true) << policy;
  }
  request["disturbance"] = Json::parse(R"({"speed": {"min": 0.4, "max": 0.8}, "turn": {"min": 0.6, "max": 1},
    "stops": {"rate_per_hour": 900, "mean_s": 2}, "start_delay": {"min": 0, "max": 0.2}})");
  const Json late = answer_of(simulate_endpoint, request);
  EXPECT_EQ(late["collision_share"], 0.0);
  EXPECT_EQ(late["deadlock_share"], 0.0);
  EXPECT_GT(late["flowtime"]["mean"], late["planned"]["flowtime"]);
  EXPECT_EQ(verdict_on(plain, late["trace"]["plans"])["valid"], true);
  EXPECT_EQ(answer_of(simulate_endpoint, request)["trace"], late["trace"]);
}

TEST(Retime, TakesTimeToStartAgain) {
  Json request = corridor();
  request["plans"] = plan_of(request)["plans"];
  request["dependencies"] = Json::array();
  request.erase("map");
  request["at"] = 5.0;
  request["states"] = Json::array();
  EXPECT_NEAR(answer_of(retime_endpoint, request)["robots"][0]["t_end"], 12.0, 1e-9);
  // At 8.5 m, with 10 m to go, it is held for 2 s.
  request["states"] = {{{"robot", "a"}, {"action", 0}, {"progress", 8.0 / 18.0}, {"held_s", 2.0}}};
  EXPECT_NEAR(answer_of(retime_endpoint, request)["robots"][0]["t_end"], 5 + 2 + 10.0 / 2 + 1 + 2, 1e-9);
}

TEST(Advance, TellsTheSpeedAtTheStart) {
  const Json request = corridor();
  Json next = advanced(request, plan_of(request), 5.0, {{"commit", 1.0}});
  Json& start = next["robots"][0]["start"];
  EXPECT_EQ(start["speed"], 2.0);
  EXPECT_EQ(plan_of(next)["status"], "solved");
  const Faults wrong{{"/robots/0/start/speed", "profile"}};
  start["speed"] = 1.5;
  EXPECT_EQ(brief_faults_of(next), wrong) << "not the speed of what is committed";
  start["speed"] = -2.0;
  EXPECT_EQ(brief_faults_of(next), wrong) << "backwards";
  start["speed"] = 2000.0;
  EXPECT_EQ(brief_faults_of(next), (Faults{{"/robots/0/start/speed", "out_of_range"}}));
  start["speed"] = 2.0;
  next["robots"][0].erase("committed");
  next["robots"][0].erase("previous");
  EXPECT_EQ(brief_faults_of(next), wrong) << "nothing is committed";
  next["robots"][0].erase("linear_acceleration");
  next["robots"][0].erase("linear_deceleration");
  EXPECT_EQ(brief_faults_of(next), Faults{}) << "it stops at once";
  EXPECT_FALSE(advanced(request, plan_of(request), 0.0)["robots"][0]["start"].contains("speed"));
}

TEST(Advance, GoesOnFromTheSpeedOfAMeasuredPose) {
  const Json request = corridor();
  const auto with_speed = [&](const Json& speed) {
    Json pose{{"robot", "a"}, {"x", 8.5}, {"y", 0.5}, {"theta", 0.0}};
    if (!speed.is_null()) pose["speed"] = speed;
    return advanced(request, plan_of(request), 5.0, {{"poses", {pose}}, {"commit", 0.0}})["robots"][0];
  };
  EXPECT_EQ(with_speed(nullptr)["start"]["speed"], 2.0) << "as planned";
  const Json slow = with_speed(1.0);
  EXPECT_EQ(slow["start"]["speed"], 1.0);
  EXPECT_NEAR(slow["committed"][0]["to"]["x"], 9.5, 1e-9) << "it brakes for 2 s";
  EXPECT_TRUE(with_speed(0.0).value("committed", Json::array()).empty()) << "it stands";
}

TEST(Advance, WithoutACommitmentBrakesFromNowOn) {
  const Json request = corridor();
  const Json next = advanced(request, plan_of(request), 1.0, {{"commit", 0.0}});
  // It drives at 1 m/s after half a metre, and needs 1 m to stop.
  const Json& action = next["robots"][0]["committed"][0];
  EXPECT_NEAR(next["robots"][0]["start"]["x"], 1.0, 1e-9);
  EXPECT_NEAR(action["to"]["x"], 2.0, 1e-9);
  EXPECT_NEAR(action["t_end"], 2.0, 1e-9);
}

TEST(Advance, DoesNotBrakeBeyondThePlannedEnd) {
  const Json request = corridor();
  const Json answer = plan_of(request);
  const Json next = advanced(request, answer, 9.0, {{"commit", 1.0}});
  const Json& action = next["robots"][0]["committed"][0];
  EXPECT_NEAR(action["to"]["x"], 18.5, 1e-9);
  EXPECT_NEAR(action["t_end"], 3.0, 1e-9);
}

TEST(Advance, HoldsARobotWhenItHasStopped) {
  const Json request = corridor();
  const Json held{{"holds", {{{"robot", "a"}, {"until", 7.0}}}}};
  const Json next = advanced(request, plan_of(request), 5.0, held);
  const Json& committed = next["robots"][0]["committed"];
  ASSERT_EQ(committed.size(), 2U);
  EXPECT_NEAR(committed[0]["t_end"], 4.0, 1e-6);
  EXPECT_NEAR(committed[0]["to"]["x"], 8.5 + 4.0, 1e-6);
  EXPECT_EQ(committed[1]["type"], "wait");
  EXPECT_NEAR(committed[1]["t_end"], 7.0, 1e-9);
  EXPECT_EQ(plan_of(next)["status"], "solved");
}

TEST(Advance, GoesOnFromTheReportedSpeed) {
  const Json request = corridor();
  const Json state{{"robot", "a"}, {"action", 0}, {"progress", 0.5}, {"speed", 0.0}};
  const Json next = advanced(request, plan_of(request), 5.0, {{"states", {state}}, {"commit", 0.0}});
  EXPECT_NEAR(next["robots"][0]["start"]["x"], 9.5, 1e-9);
  EXPECT_TRUE(next["robots"][0].value("committed", Json::array()).empty()) << "it stands";
}

}  // namespace TEST_FILE
}  // namespace fleetplan::api
