// Fleets in motion: commitments, lists of goals, previous plans, moving obstacles.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "api/request/parse_request.h"
#include "tests/api/support/motion_requests.h"
#include "tests/support/unbounded_work.h"

namespace fleetplan::api {

namespace TEST_FILE {

using core::Action;
using core::MovingObstacle;
using core::Position;
using testing::IsEmpty;

PlanRequest parsed(const Json& request, const Limits& limits = {}) {
  auto result = parse_request(request.dump(), limits, unbounded_work());
  return std::move(*result);
}

TEST(ParseMotion, ReadsCommittedAndPreviousActions) {
  Json request = moving_request();
  request["robots"][0]["previous"] = two_actions();
  request["robots"][0]["previous"][1]["goal"] = 3;
  request["robots"][1]["previous"] = Json::array();
  const PlanRequest read = parsed(request);
  const core::Robot& robot = read.problem.robots()[0];
  ASSERT_EQ(robot.committed.size(), 2U);
  EXPECT_EQ(robot.committed[0].type, Action::Type::translate);
  EXPECT_EQ(robot.committed[0].t_end, 2.0);
  EXPECT_EQ(robot.committed[1].type, Action::Type::wait);
  EXPECT_FALSE(robot.committed[1].goal);
  EXPECT_EQ(robot.committed_end().position, Position(2.5, 1.5));
  EXPECT_EQ(robot.committed_until(), 3.0);
  ASSERT_TRUE(robot.previous);
  EXPECT_EQ(robot.previous->at(1).goal, 3U);
  EXPECT_TRUE(read.problem.robots()[1].committed.empty());
  ASSERT_TRUE(read.problem.robots()[1].previous);
  EXPECT_THAT(*read.problem.robots()[1].previous, IsEmpty());
}

TEST(ParseMotion, JoinsActionsWhoseNumbersWereRoundedAndKeepsThoseReceived) {
  Json request = moving_request();
  Json& committed = request["robots"][0]["committed"];
  committed[1]["t_start"] = 2.0 + 1e-7;
  committed[1]["from"]["x"] = 2.5 + 2e-7;
  committed[1]["to"]["x"] = 2.5 + 2e-7;
  const PlanRequest read = parsed(request);
  const auto& actions = read.problem.robots()[0].committed;
  EXPECT_EQ(actions[1].t_start, actions[0].t_end);
  EXPECT_EQ(actions[1].from.position, actions[0].to.position);
  EXPECT_EQ(actions[1].to.position, actions[0].to.position);
  EXPECT_EQ(read.received[0].committed.find(0), nullptr) << "the core's numbers give it back";
  const Action* const received = read.received[0].committed.find(1);
  ASSERT_NE(received, nullptr);
  EXPECT_EQ(received->t_start, 2.0 + 1e-7);
  EXPECT_EQ(received->to.position.x(), 2.5 + 2e-7);
}

TEST(ParseMotion, AllowsFastTurnsWhatDoublesLoseInLateTimes) {
  Json request = moving_request();
  Json& robot = request["robots"][0];
  robot["angular_speed"] = 1e6;
  Json& committed = robot["committed"];
  // As the service returned them: a quarter turn takes 1.5708e-6 s, and doubles are 1.5e-11 s apart here.
  const double begin = 73188.19733787222;
  const double end = 73188.19733944301;
  committed[1]["t_end"] = begin;
  committed.push_back(committed[1]);
  committed[2]["type"] = "rotate";
  committed[2]["t_start"] = begin;
  committed[2]["t_end"] = end;
  committed[2]["to"]["theta"] = committed[2]["from"]["theta"].get<double>() + std::acos(0.0);
  EXPECT_EQ(parsed(request).problem.robots()[0].committed.at(2).t_end, end);
}

TEST(ParseMotion, ReadsGoalsInTheirOrder) {
  Json request = swap_request();
  request["robots"][0].erase("goal");
  request["robots"][0]["goals"] = Json::parse(
      R"([{"x": 2.5, "y": 1.5, "theta": 1.0, "service": 4, "not_before": 20, "radius_after": 0.3,
           "linear_speed_after": 0.7}, {"x": 8.5, "y": 1.5}])");
  request["robots"][1]["goal"]["service"] = 2;
  const PlanRequest read = parsed(request);
  const core::Robot& robot = read.problem.robots()[0];
  ASSERT_EQ(robot.goal_count(), 2U);
  EXPECT_EQ(robot.goal_at(0).position, Position(2.5, 1.5));
  EXPECT_EQ(robot.goal_at(0).theta, 1.0);
  EXPECT_EQ(robot.goal_at(0).service, 4.0);
  EXPECT_EQ(robot.goal_at(0).not_before, 20.0);
  EXPECT_EQ(robot.goal_at(0).radius_after, 0.3);
  EXPECT_EQ(robot.goal_at(0).linear_speed_after, 0.7);
  EXPECT_EQ(robot.goal_at(1).radius_after, std::nullopt);
  EXPECT_EQ(robot.goal_at(1).position, Position(8.5, 1.5));
  EXPECT_EQ(robot.goal_at(1).service, 0.0);
  EXPECT_EQ(read.problem.robots()[1].goal->service, 2.0);
  EXPECT_TRUE(read.received[0].lists_visits);
  EXPECT_TRUE(read.received[1].lists_visits) << "with a service";
  EXPECT_FALSE(parsed(swap_request()).received[0].lists_visits);
}

TEST(ParseMotion, ParksARobotWithAnEmptyListOfGoals) {
  Json request = swap_request();
  request["robots"][0].erase("goal");
  request["robots"][0]["goals"] = Json::array();
  EXPECT_EQ(parsed(request).problem.robots()[0].goal_count(), 0U);
}

TEST(ParseMotion, ReadsObstaclesInTheMapFrame) {
  Json request = swap_request();
  request["map"]["origin"] = {{"x", -1.0}, {"y", 2.0}};
  for (auto& robot : request["robots"]) {
    for (const char* key : {"start", "goal"}) {
      robot[key]["x"] = robot[key]["x"].get<double>() - 1.0;
      robot[key]["y"] = robot[key]["y"].get<double>() + 2.0;
    }
  }
  request["obstacles"] = Json::array({obstacle()});
  request["obstacles"][0]["after"] = "stays";
  const PlanRequest read = parsed(request);
  ASSERT_EQ(read.problem.obstacles().size(), 1U);
  const MovingObstacle& person = read.problem.obstacles()[0];
  EXPECT_EQ(person.id, "person");
  EXPECT_EQ(person.radius, 0.3);
  EXPECT_EQ(person.after, MovingObstacle::After::stays);
  ASSERT_EQ(person.motion.size(), 2U);
  EXPECT_EQ(person.motion[1].t, 10.0);
  EXPECT_EQ(person.motion[1].position, Position(9.5, -1.5));
}

std::vector<MovingObstacle> obstacles_of(const Json& motion, const char* after) {
  Json request = swap_request();
  request["obstacles"] = Json::array({obstacle()});
  request["obstacles"][0]["motion"] = motion;
  request["obstacles"][0]["after"] = after;
  return parsed(request).problem.obstacles();
}

TEST(ParseMotion, CutsObstaclesAtTimeZero) {
  const auto cut =
      obstacles_of({entry(-9, 0, 0), entry(-1, 1, 0.5), entry(3, 5, 0.5), entry(4, 5, 1)}, "leaves");
  ASSERT_EQ(cut.size(), 1U);
  ASSERT_EQ(cut[0].motion.size(), 3U);
  EXPECT_EQ(cut[0].motion[0].t, 0.0);
  EXPECT_EQ(cut[0].motion[0].position, Position(2, 0.5)) << "a quarter of the way";
  EXPECT_EQ(cut[0].motion[1].t, 3.0);
  const auto at_zero = obstacles_of({entry(-2, 0, 0), entry(0, 1, 0.5)}, "leaves");
  ASSERT_EQ(at_zero.size(), 1U) << "it vanishes at 0, which counts as occupied";
  EXPECT_EQ(at_zero[0].motion.size(), 1U);
  EXPECT_THAT(obstacles_of({entry(-2, 0, 0), entry(-1, 1, 0.5)}, "leaves"), IsEmpty());
  const auto staying = obstacles_of({entry(-2, 0, 0), entry(-1, 1, 0.5)}, "stays");
  ASSERT_EQ(staying.size(), 1U);
  ASSERT_EQ(staying[0].motion.size(), 1U);
  EXPECT_EQ(staying[0].motion[0].t, 0.0);
  EXPECT_EQ(staying[0].motion[0].position, Position(1, 0.5));
}

TEST(ParseMotion, ReadsTheOptionsOfFleetsInMotion) {
  const PlanRequest standard = parsed(swap_request());
  EXPECT_EQ(standard.options.replan, core::PlanOptions::Replan::all);
  EXPECT_EQ(standard.options.interval_margin, 0.0);
  EXPECT_FALSE(standard.options.horizon);
  EXPECT_EQ(standard.options.start_overlap, 0.0);
  EXPECT_EQ(standard.options.goal_overlap, 0.0);
  Json request = swap_request();
  request["options"] = Json::parse(
      R"({"replan": "where_needed", "interval_margin": 0.5, "start_overlap": 0.02, "goal_overlap": 0.03,
          "horizon": 20})");
  const PlanRequest read = parsed(request);
  EXPECT_EQ(read.options.replan, core::PlanOptions::Replan::where_needed);
  EXPECT_EQ(read.options.interval_margin, 0.5);
  EXPECT_EQ(read.options.horizon, 20.0);
  EXPECT_EQ(read.options.start_overlap, 0.02);
  EXPECT_EQ(read.options.goal_overlap, 0.03);
}

TEST(ParseMotion, KeepsNoStartFreeByDefaultIfAnyRobotIsInMotion) {
  EXPECT_EQ(parsed(swap_request()).options.start_safe_interval, 3.0);
  EXPECT_EQ(parsed(moving_request()).options.start_safe_interval, 0.0);
  Json with_horizon = moving_request();
  with_horizon["options"]["horizon"] = 20;
  EXPECT_EQ(parsed(with_horizon).options.start_safe_interval, 1.0);
  Json request = swap_request();
  request["robots"][1]["previous"] = Json::array();
  EXPECT_EQ(parsed(request).options.start_safe_interval, 0.0);
  request["options"]["start_safe_interval"] = 1.5;
  EXPECT_EQ(parsed(request).options.start_safe_interval, 1.5);
}

TEST(ParseMotion, ReportsInvalidRobotsInsteadOfRefusingTheRequest) {
  Json request = swap_request();
  request["options"]["invalid_robots"] = "report";
  request["robots"][1]["goal"]["x"] = 4.5;  // in a wall
  for (const char* id : {"c", "d"}) {
    request["robots"].push_back({{"id", id}, {"start", {{"x", 2.5}, {"y", 3.5}}}});
  }
  const PlanRequest read = parsed(request);
  const auto& robots = read.problem.robots();
  EXPECT_FALSE(robots[0].invalid);
  for (const std::size_t index : {1U, 2U, 3U}) {
    EXPECT_TRUE(robots[index].invalid) << index;
    EXPECT_FALSE(robots[index].goal) << index;
    ASSERT_EQ(read.received[index].errors.size(), 1U) << index;
  }
  EXPECT_THAT(read.received[0].errors, IsEmpty());
  EXPECT_EQ(read.received[1].errors[0].pointer, "/robots/1/goal");
  EXPECT_EQ(read.received[1].errors[0].code, "goal_in_obstacle");
  EXPECT_EQ(read.received[2].errors[0].pointer, "/robots/3/start") << "both of the pair have the same error";
  EXPECT_EQ(read.received[3].errors[0].code, "starts_overlap");
}

TEST(ParseMotion, ReportsEveryInvalidRobotOfAHeap) {
  Json request = swap_request();
  request["options"]["invalid_robots"] = "report";
  for (int index = 0; index < 200; ++index) {
    request["robots"].push_back({{"id", std::to_string(index)}, {"start", {{"x", 2.5}, {"y", 3.5}}}});
  }
  const PlanRequest read = parsed(request);
  for (std::size_t index = 2; index < 202; ++index) {
    EXPECT_TRUE(read.problem.robots()[index].invalid) << index;
    EXPECT_FALSE(read.received[index].errors.empty()) << index;
  }
}

TEST(ParseMotion, RefusesOtherFaultsThanPosesEvenIfInvalidRobotsAreReported) {
  Json request = swap_request();
  request["options"]["invalid_robots"] = "report";
  request["robots"][0]["radius"] = -1;
  EXPECT_EQ(brief_faults_of(request), (Faults{{"/robots/0/radius", "out_of_range"}}));
}

}  // namespace TEST_FILE

}  // namespace fleetplan::api
