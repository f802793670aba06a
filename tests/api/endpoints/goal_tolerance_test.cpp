// Goals that are served near their pose where that has no room or no way, from the request to the next
// moment.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "api/endpoints/endpoints.h"
#include "core/model/open_goal.h"
#include "tests/api/support/answers.h"
#include "tests/api/support/motion_requests.h"

namespace fleetplan::api {
namespace TEST_FILE {

using testing::HasSubstr;

constexpr double kTolerance = 0.6;

/// A floor of 10 m x 5 m; robot 0 goes along it to (8.5, 2.5).
Json floor_request() {
  return {{"map", {{"rows", std::vector<std::string>(5, std::string(10, '.'))}}},
          {"robot_defaults", {{"radius", 0.3}, {"linear_speed", 1.0}, {"angular_speed", 2.0}}},
          {"robots",
           {{{"id", "r0"},
             {"start", pose(0.5, 2.5)},
             {"goal", {{"x", 8.5}, {"y", 2.5}, {"theta", 0.0}, {"tolerance", kTolerance}}}}}}};
}

Json place(const Json& answer, std::size_t visit = 0) { return answer["plans"][0]["visits"][visit]["place"]; }

std::string refusal_of(const Json& request) { return plan_endpoint(request.dump(), {}).body; }

double distance(const Json& place, double x, double y) {
  return std::hypot(place["x"].get<double>() - x, place["y"].get<double>() - y);
}

void expect_near(const Json& request, const Json& answer, double x, double y) {
  ASSERT_EQ(answer["status"], "solved") << answer.dump();
  EXPECT_GT(distance(place(answer), x, y), 1e-6);
  EXPECT_LE(distance(place(answer), x, y), kTolerance + 1e-9);
  EXPECT_NEAR(answer["plans"][0]["actions"].back()["to"]["x"].get<double>(), place(answer)["x"].get<double>(),
              1e-9);
  EXPECT_EQ(answer["plans"][0]["actions"].back()["to"]["theta"], 0.0);
  EXPECT_EQ(verdict_of(request, answer)["violations"], Json::array());
}

TEST(GoalTolerance, APoseThatCanBeReachedIsTakenAsWithoutIt) {
  const Json request = floor_request();
  Json plain = request;
  plain["robots"][0]["goal"].erase("tolerance");
  const Json answer = plan_of(request);
  EXPECT_EQ(answer["plans"][0]["actions"], plan_of(plain)["plans"][0]["actions"]);
  EXPECT_EQ(place(answer), Json({{"x", 8.5}, {"y", 2.5}}));
  EXPECT_EQ(verdict_of(request, answer)["violations"], Json::array());
}

TEST(GoalTolerance, APoseInAWallIsServedBesideIt) {
  Json request = floor_request();
  request["map"]["rows"][2] = "........#.";
  request["robots"][0]["goal"]["x"] = 7.8;
  const Json answer = plan_of(request);
  expect_near(request, answer, 7.8, 2.5);
  EXPECT_LE(distance(place(answer), 7.8, 2.5), 0.1 + kTolerance / 8.0) << "the nearest one, nearly";
}

TEST(GoalTolerance, APoseWhereAnotherRobotStaysIsServedBesideIt) {
  for (const bool is_parked : {false, true}) {
    Json request = floor_request();
    Json other{{"id", "r1"}, {"start", pose(8.5, 2.2)}};
    if (!is_parked) {
      other["start"] = pose(0.5, 4.5);
      other["goal"] = {{"x", 8.5}, {"y", 2.2}};
    }
    request["robots"].push_back(other);
    expect_near(request, plan_of(request), 8.5, 2.5);
  }
}

TEST(GoalTolerance, APoseWithoutAWayIsServedWhereThereIsOne) {
  Json request = floor_request();
  // The pose is in a room without a door, near its wall.
  std::vector<std::string> rows(20, std::string(40, '.'));
  for (const std::size_t row : {8, 11}) rows[row].replace(32, 4, "####");
  for (const std::size_t row : {9, 10}) rows[row].replace(32, 4, "#..#");
  request["map"] = {{"resolution", 0.25}, {"rows", rows}};
  request["robot_defaults"]["radius"] = 0.1;
  request["robots"][0]["goal"]["x"] = 8.4;
  expect_near(request, plan_of(request), 8.4, 2.5);
  request["robots"][0]["goal"].erase("tolerance");
  EXPECT_EQ(plan_of(request)["unplanned"][0]["reason"], "goal_unreachable");
}

TEST(GoalTolerance, TwoRobotsWithTheSameGoalStandSideBySide) {
  Json request = floor_request();
  request["robots"].push_back(request["robots"][0]);
  request["robots"][1]["id"] = "r1";
  request["robots"][1]["start"] = pose(0.5, 4.5);
  for (Json& robot : request["robots"]) robot["goal"]["tolerance"] = 0.7;
  const Json answer = plan_of(request);
  ASSERT_EQ(answer["status"], "solved");
  EXPECT_EQ(verdict_of(request, answer)["violations"], Json::array());
}

TEST(GoalTolerance, WithoutRoomNearbyTheFaultIsThatOfTheGoal) {
  Json request = floor_request();
  request["map"]["rows"] = {"..........", ".......###", ".......###", ".......###", ".........."};
  EXPECT_THAT(refusal_of(request), HasSubstr("goal_in_obstacle"));
  request["robots"][0]["goal"]["tolerance"] = 1.5;
  EXPECT_THAT(refusal_of(request), HasSubstr("/robots/0/goal/tolerance"));
}

TEST(GoalTolerance, APlaceIsNoFartherThanTheTolerance) {
  Json request = floor_request();
  request["robots"][0]["goal"]["place"] = {{"x", 8.5}, {"y", 3.2}};
  EXPECT_THAT(refusal_of(request), HasSubstr("/robots/0/goal/place"));
  request["robots"][0]["goal"].erase("tolerance");
  EXPECT_THAT(refusal_of(request), HasSubstr("no tolerance"));
}

TEST(GoalTolerance, APlaceThatIsToldAgainTakesThePlaceOfTheOneBefore) {
  core::OpenGoal open{.poses = {{{1.0, 1.0}, 0.5}}, .tolerance = 0.5, .own = {1.0, 1.0}};
  // Plans may tell the same goal any number of times.
  for (int k = 0; k < 1000; ++k) ASSERT_TRUE(core::take_place(open, {1.2, 1.0}));
  EXPECT_EQ(open.poses.size(), 2U);
  EXPECT_EQ(open.choice().position, core::Position(1.2, 1.0));
  EXPECT_EQ(open.choice().theta, 0.5);
  EXPECT_FALSE(core::take_place(open, {1.6, 1.0})) << "it is too far";
  EXPECT_EQ(open.choice().position, core::Position(1.2, 1.0));
  ASSERT_TRUE(core::take_place(open, {1.0, 1.0}));
  EXPECT_EQ(open.poses.size(), 1U);
  EXPECT_TRUE(open.may_widen());
}

TEST(GoalTolerance, TheCheckHoldsThePlanToThePlaceThatItNames) {
  Json request = floor_request();
  request["map"]["rows"][2] = "........#.";
  request["robots"][0]["goal"]["x"] = 7.8;
  Json answer = plan_of(request);
  ASSERT_EQ(answer["status"], "solved");
  answer["plans"][0]["visits"][0]["place"] = {{"x", 7.8}, {"y", 2.5}};
  EXPECT_EQ(verdict_of(request, answer)["valid"], false);
}

TEST(GoalTolerance, TheNextMomentKeepsTheGoalAndThePlace) {
  Json request = floor_request();
  request["map"]["rows"][2] = "........#.";
  request["robots"][0]["goal"]["x"] = 7.8;
  const Json answer = plan_of(request);
  ASSERT_EQ(answer["status"], "solved");
  const Json next = advanced(request, answer, 3.0, {{"commit", 1.0}});
  const Json& goal = next["robots"][0]["goal"];
  EXPECT_EQ(goal["tolerance"], kTolerance);
  EXPECT_EQ(goal["x"], 7.8);
  EXPECT_NEAR(goal["place"]["x"].get<double>(), place(answer)["x"].get<double>(), 1e-9);
  const Json later = plan_of(next);
  ASSERT_EQ(later["status"], "solved");
  EXPECT_NEAR(distance(place(later), goal["place"]["x"], goal["place"]["y"]), 0.0, 1e-9)
      << "it goes on to where it has been going";
  const Json at_the_end = advanced(request, answer, 100.0)["robots"][0]["goal"];
  EXPECT_FALSE(at_the_end.contains("tolerance")) << "it stays where it was served";
  EXPECT_NEAR(distance(place(answer), at_the_end["x"], at_the_end["y"]), 0.0, 1e-9);
}

}  // namespace TEST_FILE
}  // namespace fleetplan::api
