// Answers for fleets in motion, and their check by /v1/validate; and robots that translate backwards, from
// the request to the next moment.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "api/endpoints/endpoints.h"
#include "tests/api/support/answers.h"
#include "tests/api/support/fault_case.h"
#include "tests/api/support/motion_requests.h"

namespace fleetplan::api {

namespace TEST_FILE {

void move_by(Json& position, double x, double y) {
  position["x"] = position["x"].get<double>() + x;
  position["y"] = position["y"].get<double>() + y;
}

/// The request in a world whose coordinates do not come back after the map's origin is subtracted and added.
Json far_away() {
  Json request = moving_request();
  request["map"]["origin"] = {{"x", -1000.1}, {"y", 0.7}};
  for (Json& robot : request["robots"]) {
    for (const char* key : {"start", "goal"}) move_by(robot[key], -1000.1, 0.7);
  }
  for (Json& one : request["robots"][0]["committed"]) {
    for (const char* key : {"from", "to"}) move_by(one[key], -1000.1, 0.7);
  }
  return request;
}

TEST(MotionAnswer, BeginsWithTheCommittedActionsAsReceived) {
  for (const Json& request : {moving_request(), far_away()}) {
    const Json answer = plan_of(request);
    ASSERT_EQ(answer["status"], "solved") << answer.dump();
    const Json& actions = answer["plans"][0]["actions"];
    ASSERT_GT(actions.size(), 2U);
    const Json& committed = request["robots"][0]["committed"];
    for (std::size_t index = 0; index < committed.size(); ++index) {
      EXPECT_EQ(actions[index], committed[index]) << index;
    }
    EXPECT_EQ(actions[2]["from"]["x"], committed[1]["to"]["x"]) << "contiguous";
    EXPECT_FALSE(answer["plans"][0].contains("visits"));
    EXPECT_FALSE(answer.contains("unavoidable"));
    EXPECT_EQ(verdict_of(request, answer)["violations"], Json::array());
  }
}

TEST(MotionAnswer, ListsTheVisitsOfGoals) {
  Json request = moving_request();
  request["robots"][0].erase("goal");
  request["robots"][0]["goals"] =
      Json::parse(R"([{"x": 2.5, "y": 1.5, "service": 4}, {"x": 8.5, "y": 1.5, "service": 2}])");
  request["options"]["priority"] = "as_listed";
  const Json answer = plan_of(request);
  ASSERT_EQ(answer["status"], "solved") << answer.dump();
  const Json& plan = answer["plans"][0];
  ASSERT_EQ(plan["visits"].size(), 2U);
  EXPECT_EQ(plan["visits"][0], (Json{{"goal", 0}, {"t_arrive", 2.0}, {"t_leave", 6.0}}));
  EXPECT_EQ(plan["visits"][1]["goal"], 1);
  EXPECT_EQ(plan["visits"][1]["t_leave"], nullptr);
  EXPECT_EQ(plan["actions"].back()["goal"], 1) << "the last action is the service";
  EXPECT_EQ(plan["actions"].back()["t_end"], plan["cost"]);
  EXPECT_FALSE(answer["plans"][1].contains("visits"));
  EXPECT_EQ(verdict_of(request, answer)["violations"], Json::array());
}

TEST(MotionAnswer, TellsHowLateRobotsAre) {
  Json request = swap_request();
  EXPECT_FALSE(plan_of(request).contains("objective_value"));
  request["options"]["objective"] = "tardiness";
  EXPECT_EQ(plan_of(request)["objective_value"], 0.0) << "nothing is due";
  request["robots"][0]["goal"]["due"] = -2.0;
  request["robots"][0]["weight"] = 3.0;
  request["robots"][1]["goal"]["due"] = 1000.0;
  const Json answer = plan_of(request);
  ASSERT_EQ(answer["status"], "solved") << answer.dump();
  const Json& visit = answer["plans"][0]["visits"][0];
  const double late = visit["t_arrive"].get<double>() + 2.0;
  EXPECT_DOUBLE_EQ(visit["late_by"].get<double>(), late);
  EXPECT_EQ(answer["plans"][1]["visits"][0]["late_by"], 0.0);
  EXPECT_DOUBLE_EQ(answer["objective_value"].get<double>(), 3.0 * late);
  EXPECT_EQ(verdict_of(request, answer)["violations"], Json::array()) << "late_by is ignored";
}

TEST(MotionAnswer, CountsCostsByWeight) {
  Json request = swap_request();
  request["robots"][1]["weight"] = 0.5;
  const Json answer = plan_of(request);
  ASSERT_EQ(answer["status"], "solved") << answer.dump();
  const double first = answer["plans"][0]["cost"].get<double>();
  const double second = answer["plans"][1]["cost"].get<double>();
  EXPECT_DOUBLE_EQ(answer["objective_value"].get<double>(), first + 0.5 * second);
  EXPECT_DOUBLE_EQ(answer["flowtime"].get<double>(), first + second);
}

TEST(MotionAnswer, EstimatesHowLateRobotsAreBeyondTheHorizon) {
  Json request = swap_request();
  request["options"]["horizon"] = 1.0;
  request["options"]["objective"] = "tardiness";
  request["robots"][0]["goal"]["due"] = 0.0;
  const Json answer = plan_of(request);
  const Json& visit = answer["plans"][0]["visits"][0];
  EXPECT_EQ(visit["t_arrive"], nullptr);
  EXPECT_EQ(visit["late_by"], visit["estimated_t_arrive"]);
  EXPECT_DOUBLE_EQ(answer["objective_value"].get<double>(), visit["late_by"].get<double>());
}

/// Robot "a" passes a corridor with a bay, in which "b" stands.
Json corridor_request() {
  Json request = swap_request();
  request["map"]["rows"] = {"#####.#####", "..........."};
  request["map"]["resolution"] = 1.0;
  request["robots"] = {{{"id", "a"}, {"start", pose(0.5, 0.5)}, {"goal", {{"x", 10.5}, {"y", 0.5}}}},
                       {{"id", "b"}, {"start", pose(7.5, 0.5)}}};
  return request;
}

/// The request of a moment of the answer.
Json advanced_request(const Json& request, const Json& answer, double at) {
  const Json body{{"request", request}, {"plans", answer["plans"]}, {"at", at}};
  const Reply reply = advance_endpoint(body.dump(), {});
  EXPECT_EQ(reply.status, 200) << reply.body;
  return json_of(reply);
}

TEST(MotionAnswer, OfAnIdleRobotThatYieldsHasItsWay) {
  Json request = corridor_request();
  EXPECT_EQ(plan_of(request)["status"], "partial") << "by default it stays";
  request["robots"][1]["idle"] = "yield";
  const Json answer = plan_of(request);
  ASSERT_EQ(answer["status"], "solved") << answer.dump();
  const Json& yields = answer["plans"][1];
  EXPECT_FALSE(yields.contains("visits"));
  EXPECT_EQ(yields["actions"].back()["to"]["x"], 5.5) << "in the bay";
  EXPECT_EQ(yields["cost"], yields["actions"].back()["t_end"]);
  EXPECT_EQ(verdict_of(request, answer)["violations"], Json::array());
  const Json later = advanced_request(request, answer, answer["makespan"].get<double>() + 1.0);
  EXPECT_FALSE(later["robots"][1].contains("goal"));
  EXPECT_FALSE(later["robots"][1].contains("goals"));
  EXPECT_EQ(later["robots"][1]["idle"], "yield");
  EXPECT_EQ(plan_of(later)["plans"][1]["actions"], Json::array()) << "nobody needs the bay";
}

TEST(MotionAnswer, OfAnIdleRobotThatReturnsComesBack) {
  Json request = corridor_request();
  request["robots"][1]["idle"] = "return";
  const Json answer = plan_of(request);
  ASSERT_EQ(answer["status"], "solved") << answer.dump();
  EXPECT_EQ(answer["plans"][1]["actions"].back()["to"]["x"], 7.5);
  EXPECT_EQ(verdict_of(request, answer)["violations"], Json::array());
  const Json later = advanced_request(request, answer, 6.0);
  EXPECT_EQ(later["robots"][1]["goal"]["x"], 7.5) << "wherever it is at that moment";
}

TEST(MotionAnswer, RobotsThatYieldMayShareTheirLastGoal) {
  Json request = swap_request();
  for (Json& robot : request["robots"]) {
    robot["goals"] = Json::array({{{"x", 4.5}, {"y", 3.5}, {"service", 5}}});
    robot.erase("goal");
    robot["idle"] = "yield";
  }
  const Json answer = plan_of(request);
  ASSERT_EQ(answer["status"], "solved") << answer.dump();
  for (const Json& plan : answer["plans"]) {
    ASSERT_EQ(plan["visits"].size(), 1U);
    EXPECT_TRUE(plan["visits"][0]["t_leave"].is_number());
  }
  EXPECT_EQ(verdict_of(request, answer)["violations"], Json::array());
  const Json later = advanced_request(request, answer, answer["makespan"].get<double>() + 1.0);
  for (const Json& robot : later["robots"]) EXPECT_FALSE(robot.contains("goals")) << "it has been served";
}

TEST(MotionAnswer, ARobotThatIsToStayHasNoGoalOnceItIsServed) {
  Json request = swap_request();
  request["robots"][0]["idle"] = "stay";
  const Json answer = plan_of(request);
  const Json later = advanced_request(request, answer, answer["makespan"].get<double>() + 1.0);
  EXPECT_FALSE(later["robots"][0].contains("goal"));
  EXPECT_TRUE(later["robots"][1].contains("goal"));
  EXPECT_TRUE(advanced_request(request, answer, 1.0)["robots"][0].contains("goal"));
}

TEST(MotionAnswer, OfAnUnplannedRobotHasItsCommittedActions) {
  Json request = moving_request();
  request["robots"][0]["committed"].erase(1);
  request["map"]["rows"] = {".......#.", "....#..#.", "....#..#.", ".......#."};
  const Json answer = plan_of(request);
  ASSERT_EQ(answer["status"], "none") << answer.dump();
  EXPECT_EQ(answer["unplanned"][0]["actions"], request["robots"][0]["committed"]);
  EXPECT_FALSE(answer["unplanned"][1].contains("actions"));
  EXPECT_EQ(verdict_of(request, answer)["violations"], Json::array());
}

/// No robot moves: all robots except the invalid ones are out of time.
core::Plan stuck_planner(const core::Problem& problem, const core::PlanOptions& /*options*/,
                         const core::StopCondition& /*stop*/, core::Observer* /*observer*/) {
  core::Plan plan;
  for (std::size_t index = 0; index < problem.robots().size(); ++index) {
    const core::Robot& robot = problem.robots()[index];
    if (!robot.invalid && !robot.goal) {
      plan.plans.push_back({index, 0.0, {}});
      continue;
    }
    using Reason = core::Unplanned::Reason;
    plan.unplanned.push_back({index, robot.invalid ? Reason::invalid : Reason::budget_exhausted, "", {}});
  }
  return plan;
}

TEST(MotionAnswer, ReportsInvalidRobotsWithTheirErrors) {
  Json request = swap_request();
  request["robots"].push_back({{"id", "parked"}, {"start", {{"x", 2.5}, {"y", 0.5}}}});
  request["robots"].push_back({{"id", "stuck"}, {"start", {{"x", 4.5}, {"y", 1.5}}}});
  const auto refused = faults_of(request.dump());
  ASSERT_EQ(refused.size(), 1U);
  request["options"]["invalid_robots"] = "report";
  const Reply reply = plan_with(stuck_planner, request.dump(), {});
  const Json answer = json_of(reply);
  ASSERT_EQ(answer["status"], "partial") << reply.body;
  const Json& stuck = answer["unplanned"][2];
  EXPECT_EQ(stuck["reason"], "invalid");
  EXPECT_EQ(stuck["errors"][0]["pointer"], refused[0].pointer);
  EXPECT_EQ(stuck["errors"][0]["code"], refused[0].code);
  EXPECT_EQ(stuck["errors"][0]["detail"], refused[0].detail);
  constexpr auto kInvalid = static_cast<std::size_t>(core::Unplanned::Reason::invalid);
  EXPECT_EQ(reply.outcome->unplanned_by_reason[kInvalid], 1U);
  EXPECT_EQ(verdict_of(request, answer)["violations"], Json::array());
}

TEST(MotionAnswer, KeepsClearOfMovingObstacles) {
  Json request = swap_request();
  request["obstacles"] = Json::array({obstacle()});
  const Json answer = plan_of(request);
  EXPECT_EQ(answer["status"], "solved") << answer.dump();
  EXPECT_EQ(verdict_of(request, answer)["violations"], Json::array());
}

TEST(MotionAnswer, IsCheckedAgainstMovingObstacles) {
  Json request = swap_request();
  request["plans"] = Json::array();
  request["obstacles"] = Json::parse(
      R"([{"id": "person", "radius": 0.3, "motion": [{"t": 0, "x": 0.5, "y": 0.5}, {"t": 4, "x": 0.5, "y": 2.5}]}])");
  const Json verdict = verdict_of(request, Json::object());
  ASSERT_EQ(verdict["violations"].size(), 1U) << verdict.dump();
  EXPECT_EQ(verdict["violations"][0]["kind"], "moving_obstacle");
  EXPECT_EQ(verdict["violations"][0]["obstacle"], "person");
  EXPECT_EQ(verdict["violations"][0]["robots"], Json::array({"a"}));
  request["unavoidable"] = Json::parse(R"([{"robot": "a", "obstacle": "person", "t": 1.0}])");
  EXPECT_EQ(verdict_of(request, Json::object())["violations"], Json::array());
}

TEST(MotionAnswer, SaysWhereAPlanStopsAtTheHorizon) {
  Json request = swap_request();
  request["options"]["horizon"] = 3.0;
  const Json answer = plan_of(request);
  ASSERT_EQ(answer["status"], "solved") << answer.dump();
  for (const Json& plan : answer["plans"]) {
    EXPECT_EQ(plan["ends_at"], "horizon");
    EXPECT_GE(plan["cost"], 3.0);
    EXPECT_EQ(plan["cost"], plan["actions"].back()["t_end"]);
    EXPECT_GT(plan["estimated_cost"], 8.0) << "the whole way";
    EXPECT_LE(plan["lower_bound"], 3.0);
  }
  EXPECT_EQ(answer["estimated"]["flowtime"].get<double>(),
            answer["plans"][0]["estimated_cost"].get<double>() +
                answer["plans"][1]["estimated_cost"].get<double>());
  EXPECT_EQ(verdict_of(request, answer)["violations"], Json::array());
  request["options"]["horizon"] = 30.0;
  EXPECT_EQ(verdict_of(request, answer)["violations"][0]["kind"], "wrong_goal");
  const Json whole = plan_of(request);
  for (const Json& plan : whole["plans"]) EXPECT_FALSE(plan.contains("ends_at"));
  EXPECT_EQ(whole["estimated"]["flowtime"], whole["flowtime"]);
  request["options"].erase("horizon");
  EXPECT_FALSE(plan_of(request).contains("estimated"));
}

using testing::HasSubstr;

/// A corridor of 20 m in which robot "b" is parked before robot "a".
Json queue_request() {
  return Json::parse(R"({
    "map": {"rows": ["...................."]},
    "robot_defaults": {"radius": 0.4, "linear_speed": 1.0, "angular_speed": 1.5},
    "robots": [{"id": "a", "start": {"x": 2.5, "y": 0.5, "theta": 0.0},
                "goals": [{"x": 2.5, "y": 0.5}, {"x": 10.5, "y": 0.5, "service": 2.0}, {"x": 12.5, "y": 0.5}]},
               {"id": "b", "start": {"x": 3.5, "y": 0.5, "theta": 0.0}}],
    "options": {"horizon": 5.0}})");
}

TEST(MotionAnswer, EstimatesWhenGoalsBeyondTheHorizonAreVisited) {
  Json request = queue_request();
  request["robots"].erase(1);
  const Json answer = plan_of(request);
  EXPECT_EQ(answer["warnings"], Json::array());
  const Json& plan = answer["plans"][0];
  EXPECT_FALSE(plan.contains("stuck"));
  ASSERT_EQ(plan["visits"].size(), 3U) << plan.dump();
  EXPECT_EQ(plan["visits"][0]["t_arrive"], 0.0);
  EXPECT_FALSE(plan["visits"][0].contains("estimated_t_arrive"));
  EXPECT_EQ(plan["visits"][1]["t_arrive"], nullptr);
  EXPECT_EQ(plan["visits"][1]["t_leave"], nullptr);
  EXPECT_NEAR(plan["visits"][1]["estimated_t_arrive"], 8.0, 1e-9);
  EXPECT_NEAR(plan["visits"][2]["estimated_t_arrive"], 12.0, 1e-9);
  EXPECT_NEAR(plan["estimated_cost"], 12.0, 1e-9);
  EXPECT_EQ(verdict_of(request, answer)["violations"], Json::array());
}

TEST(MotionAnswer, SaysWhoIsStuckAndWhy) {
  const Json request = queue_request();
  const Json answer = plan_of(request);
  const Json& plan = answer["plans"][0];
  EXPECT_EQ(plan["stuck"], true);
  EXPECT_EQ(plan["blocked_by"], Json::array({"b"}));
  EXPECT_EQ(plan["blocked_by_total"], 1);
  EXPECT_EQ(plan["ends_at"], "horizon");
  EXPECT_EQ(plan["estimated_cost"], nullptr) << "it has no way";
  EXPECT_EQ(plan["visits"][1]["estimated_t_arrive"], nullptr);
  EXPECT_EQ(answer["estimated"]["flowtime"], 0.0);
  ASSERT_EQ(answer["warnings"].size(), 1U);
  EXPECT_THAT(answer["warnings"][0].get<std::string>(), HasSubstr("within the horizon: \"a\"."));
  EXPECT_FALSE(answer["plans"][1].contains("stuck"));
  EXPECT_EQ(verdict_of(request, answer)["violations"], Json::array());
}

TEST(MotionAnswer, NamesTheFirstFewRobotsThatAreStuck) {
  Json request = queue_request();
  request["map"]["rows"] =
      Json::array({"........", "########", "........", "########", "........", "########", "........",
                   "########", "........", "########", "........", "########"});
  request["robots"] = Json::array();
  for (int row = 0; row < 6; ++row) {
    const std::string name = std::to_string(row);
    const double y = 1.5 + 2.0 * row;
    request["robots"].push_back(
        {{"id", "a" + name}, {"start", {{"x", 2.5}, {"y", y}}}, {"goal", {{"x", 7.5}, {"y", y}}}});
    request["robots"].push_back({{"id", "b" + name}, {"start", {{"x", 3.5}, {"y", y}}}});
  }
  const Json answer = plan_of(request);
  EXPECT_THAT(answer["warnings"][0].get<std::string>(),
              HasSubstr(R"(: "a0", "a1", "a2", "a3", "a4" and 1 more.)"));
}

/// Robot "a" looks away from its goal, in a corridor.
Json backing_request() {
  return Json::parse(R"({
    "map": {"rows": ["........."], "origin": {"x": 0.1, "y": 0.2}},
    "robot_defaults": {"radius": 0.3, "linear_speed": 1.0, "angular_speed": 0.5, "may_reverse": true},
    "robots": [{"id": "a", "start": {"x": 6.6, "y": 0.7, "theta": 0.0}, "goal": {"x": 0.6, "y": 0.7}}]})");
}

TEST(Reverse, ThePlanHasATranslationBackwards) {
  const Json answer = plan_of(backing_request());
  const Json& actions = answer["plans"][0]["actions"];
  ASSERT_EQ(actions.size(), 1U);
  EXPECT_EQ(actions[0]["type"], "translate");
  EXPECT_EQ(actions[0]["reverse"], true);
  EXPECT_EQ(actions[0]["to"]["theta"], 0.0);
}

TEST(Reverse, ARobotThatMayNotTurns) {
  Json request = backing_request();
  request["robots"][0]["may_reverse"] = false;
  const Json answer = plan_of(request);
  ASSERT_EQ(answer["plans"][0]["actions"].size(), 2U);
  EXPECT_FALSE(answer["plans"][0]["actions"][1].contains("reverse"));
}

TEST(Reverse, ThePlanIsValidForRobotsThatMayOnly) {
  Json request = backing_request();
  request["plans"] = plan_of(request)["plans"];
  EXPECT_EQ(answer_of(validate_endpoint, request)["valid"], true);
  request["robots"][0]["may_reverse"] = false;
  const Json verdict = answer_of(validate_endpoint, request);
  ASSERT_EQ(verdict["violations"].size(), 1U);
  EXPECT_EQ(verdict["violations"][0]["kind"], "speed");
}

TEST(Reverse, AMoveBackwardsUnderWayGoesOn) {
  const Json request = backing_request();
  const Json answer = plan_of(request);
  const Json body = {{"request", request}, {"plans", answer["plans"]}, {"at", 2.0}};
  const Json next = answer_of(advance_endpoint, body);
  EXPECT_EQ(next["robots"][0]["committed"][0]["reverse"], true);
  EXPECT_EQ(next["robots"][0]["previous"][0]["reverse"], true);
  EXPECT_EQ(next["robot_defaults"]["may_reverse"], true);
  const Json again = plan_of(next);
  ASSERT_EQ(again["plans"][0]["actions"].size(), 1U);
  EXPECT_EQ(again["plans"][0]["actions"][0]["reverse"], true);
  EXPECT_EQ(again["plans"][0]["actions"][0]["t_end"], 4.0);
}

TEST(Reverse, ThatIsNotPossibleIsAFault) {
  const auto back = [](Json& r) -> Json& {
    robot(r, 0)["committed"] = Json::array({action("translate", 0.0, 1.0, pose(0.5, 1.5, 3.141592653589793),
                                                   pose(1.5, 1.5, 3.141592653589793))});
    robot(r, 0)["start"]["theta"] = 3.141592653589793;
    robot(r, 0)["may_reverse"] = true;
    robot(r, 0)["committed"][0]["reverse"] = true;
    return robot(r, 0);
  };
  Json valid = swap_request();
  back(valid);
  EXPECT_TRUE(faults_of(valid.dump()).empty());
  const std::vector<FaultCase> cases{
      {"MayNot", [&](Json& r) { back(r)["may_reverse"] = false; }, "/robots/0/committed/0/reverse", "speed",
       "may not"},
      {"LeadsAhead",
       [&](Json& r) {
         Json& one = back(r);
         for (const char* end : {"from", "to"}) one["committed"][0][end]["theta"] = 0.0;
         one["start"]["theta"] = 0.0;
       },
       "/robots/0/committed/0/reverse", "speed", "1 m ahead"},
      {"OfAWait",
       [&](Json& r) {
         back(r)["committed"][0]["type"] = "wait";
         robot(r, 0)["committed"][0]["to"] = robot(r, 0)["committed"][0]["from"];
       },
       "/robots/0/committed/0/reverse", "unknown_key", "translate actions only"},
      {"NoBoolean", [](Json& r) { robot(r, 0)["may_reverse"] = 1; }, "/robots/0/may_reverse", "wrong_type",
       "true or false"}};
  for (const FaultCase& one : cases) expect_one_fault(swap_request(), one);
}

}  // namespace TEST_FILE

}  // namespace fleetplan::api
