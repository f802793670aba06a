// Answers for fleets in motion, and their check by /v1/validate.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "api/endpoints/endpoints.h"
#include "tests/api/support/motion_requests.h"

namespace fleetplan::api {
namespace TEST_FILE {

Json answer_of(const Json& request) {
  const Reply reply = plan_endpoint(request.dump(), {});
  EXPECT_EQ(reply.status, 200) << reply.body;
  return json_of(reply);
}

/// The verdict on an answer that is merged into its request.
Json verdict_of(Json request, const Json& answer) {
  request.update(answer);
  const Reply reply = validate_endpoint(request.dump(), {});
  EXPECT_EQ(reply.status, 200) << reply.body;
  return json_of(reply);
}

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
    const Json answer = answer_of(request);
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
  const Json answer = answer_of(request);
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

TEST(MotionAnswer, OfAnUnplannedRobotHasItsCommittedActions) {
  Json request = moving_request();
  request["robots"][0]["committed"].erase(1);
  request["map"]["rows"] = {".......#.", "....#..#.", "....#..#.", ".......#."};
  const Json answer = answer_of(request);
  ASSERT_EQ(answer["status"], "none") << answer.dump();
  EXPECT_EQ(answer["unplanned"][0]["actions"], request["robots"][0]["committed"]);
  EXPECT_FALSE(answer["unplanned"][1].contains("actions"));
  EXPECT_EQ(verdict_of(request, answer)["violations"], Json::array());
}

/// Nobody moves: all robots but the invalid ones are out of time.
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
  const Json answer = answer_of(request);
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
  const Json answer = answer_of(request);
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
  const Json whole = answer_of(request);
  for (const Json& plan : whole["plans"]) EXPECT_FALSE(plan.contains("ends_at"));
  EXPECT_EQ(whole["estimated"]["flowtime"], whole["flowtime"]);
  request["options"].erase("horizon");
  EXPECT_FALSE(answer_of(request).contains("estimated"));
}

}  // namespace TEST_FILE
}  // namespace fleetplan::api
