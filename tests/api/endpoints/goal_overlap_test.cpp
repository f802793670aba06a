// Docks in mapped walls: last goals at which robots overlap walls, as the option goal_overlap allows.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "api/endpoints/endpoints.h"
#include "tests/api/support/answers.h"
#include "tests/api/support/requests.h"

namespace fleetplan::api {
namespace TEST_FILE {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr double kDown = -1.5707963267948966;

/// A hall of 6 x 3 m. Robots have a radius of 0.3 m. Docks are at its lower wall: at y = 0.25, their disks
/// are 0.05 m in it.
Json hall() {
  return Json::parse(R"({
    "map": {"rows": ["............", "............", "............", "............", "............",
                     "............"], "resolution": 0.5},
    "robot_defaults": {"radius": 0.3, "linear_speed": 1, "angular_speed": 2},
    "robots": [], "options": {"goal_overlap": 0.06}})");
}

Json pose(double x, double y) { return {{"x", x}, {"y", y}, {"theta", kDown}}; }

void add(Json& request, const char* id, const Json& start, const Json& goal) {
  request["robots"].push_back({{"id", id}, {"start", start}, {"goal", goal}});
}

/// Expects that all robots have plans that the check accepts.
Json solved(const Json& request) {
  const Json answer = plan_of(request);
  EXPECT_EQ(answer["status"], "solved") << answer["unplanned"];
  EXPECT_EQ(answer["verified"], true);
  const Json verdict = verdict_of(request, answer);
  EXPECT_EQ(verdict["violations"], Json::array());
  return answer;
}

TEST(GoalOverlap, LetsRobotsIntoDocksSideBySide) {
  Json request = hall();
  add(request, "a", pose(0.75, 2.5), pose(4.0, 0.25));
  add(request, "b", pose(5.25, 2.5), pose(3.4, 0.25));
  add(request, "c", pose(3.0, 2.0), pose(2.8, 0.25));
  const Json answer = solved(request);
  for (const Json& plan : answer["plans"]) {
    const Json& end = plan["actions"].back()["to"];
    EXPECT_NEAR(end["y"].get<double>(), 0.25, 1e-9);
  }
  request["options"]["goal_overlap"] = 0.049;
  EXPECT_EQ(faults_of(request.dump()).size(), 3U);
}

TEST(GoalOverlap, OfMoreThanTheOptionIsRefusedWithTheOverlapThatSuffices) {
  for (const double inflation : {0.0, 0.02}) {
    Json request = hall();
    request["options"] = {{"inflation", inflation}};
    add(request, "a", pose(1.0, 2.0), pose(4.0, 0.2));
    const auto faults = faults_of(request.dump());
    ASSERT_EQ(faults.size(), 1U);
    EXPECT_EQ(faults[0].code, "goal_in_obstacle");
    EXPECT_THAT(faults[0].detail, HasSubstr(inflation > 0.0 ? "options.goal_overlap of at least 0.12 m"
                                                            : "options.goal_overlap of at least 0.1 m"));
    request["options"]["goal_overlap"] = 0.1 + inflation;
    solved(request);
  }
}

TEST(GoalOverlap, IsNoRemedyWhereARobotDoesNotStay) {
  Json request = hall();
  add(request, "a", pose(1.0, 2.0), pose(4.0, 0.2));
  request["robots"][0]["idle"] = "yield";
  EXPECT_THAT(faults_of(request.dump()).at(0).detail, Not(HasSubstr("goal_overlap")));
  request["robots"][0].erase("idle");
  request["robots"][0].erase("goal");
  request["robots"][0]["goals"] = {pose(4.0, 0.2), pose(4.0, 2.0)};
  EXPECT_THAT(faults_of(request.dump()).at(0).detail, Not(HasSubstr("goal_overlap")));
  request["robots"][0]["goals"] = {pose(4.0, 2.0), pose(4.0, 0.0)};
  EXPECT_THAT(faults_of(request.dump()).at(0).detail, Not(HasSubstr("goal_overlap")))
      << "its centre is in the wall";
}

TEST(GoalOverlap, LetsARobotLeaveItsDockAndComeBack) {
  Json request = hall();
  add(request, "a", pose(4.0, 0.25), pose(1.0, 2.0));
  solved(request);  // starts may overlap so much, too
  request["robots"][0].erase("goal");
  request["robots"][0]["goals"] = {pose(1.0, 2.0), pose(4.0, 0.25)};
  const Json back = solved(request);
  EXPECT_GT(back["plans"][0]["cost"].get<double>(), 5.0);
  request["robots"][0].erase("goals");
  request["robots"][0]["idle"] = "return";
  solved(request);
  request["options"] = Json::object();
  EXPECT_THAT(faults_of(request.dump()).at(0).detail, HasSubstr("options.goal_overlap"));
}

TEST(GoalOverlap, KeepsARobotInItsDock) {
  Json request = hall();
  add(request, "a", pose(4.0, 0.25), pose(4.0, 0.25));
  add(request, "b", pose(1.0, 0.75), pose(5.0, 0.75));
  const Json answer = plan_of(request);
  EXPECT_EQ(answer["plans"][0]["actions"], Json::array());
  EXPECT_EQ(verdict_of(request, answer)["violations"], Json::array());
}

TEST(GoalOverlap, IsThatOfBlockedZonesToo) {
  Json request = hall();
  request["zones"] = Json::parse(R"([{"id": "z", "type": "blocked", "polygon": [
    {"x": 3.5, "y": 0}, {"x": 4.5, "y": 0}, {"x": 4.5, "y": 1}, {"x": 3.5, "y": 1}]}])");
  add(request, "a", pose(1.0, 2.0), pose(4.0, 1.25));
  solved(request);
  request["options"]["goal_overlap"] = 0.04;
  EXPECT_EQ(faults_of(request.dump()).at(0).code, "goal_in_obstacle");
}

TEST(GoalOverlap, CountsForPosesToChooseFrom) {
  Json request = hall();
  for (const char* id : {"a", "b", "c"}) {
    add(request, id, pose(1.0 + 1.5 * static_cast<double>(request["robots"].size()), 2.0), Json::object());
    request["robots"].back()["goal"] = {{"any_of", {pose(1.0, 0.25), pose(2.0, 0.25), pose(3.0, 0.25)}}};
  }
  solved(request);
  request["options"]["goal_overlap"] = 0.04;
  EXPECT_EQ(faults_of(request.dump()).size(), 3U);
}

TEST(GoalOverlap, WithoutAStraightWayInLeavesOneRobotUnplanned) {
  // A bay as wide as a cell: in it, the disk is in both of its walls.
  Json request = Json::parse(R"({
    "map": {"rows": ["........", "........", "###.####", "###.####", "###.####", "########"],
            "resolution": 0.5},
    "robot_defaults": {"radius": 0.3, "linear_speed": 1, "angular_speed": 2},
    "robots": [], "options": {"goal_overlap": 0.06}})");
  add(request, "a", pose(0.5, 2.5), pose(1.75, 1.75));
  add(request, "b", pose(3.5, 2.5), pose(2.5, 2.5));
  solved(request);
  request["robots"][0]["goal"] = pose(1.75, 0.75);  // far from where the whole disk fits
  const Json answer = plan_of(request);
  EXPECT_EQ(answer["status"], "partial");
  ASSERT_EQ(answer["unplanned"].size(), 1U);
  EXPECT_EQ(answer["unplanned"][0]["reason"], "goal_blocked");
  EXPECT_THAT(answer["unplanned"][0]["detail"].get<std::string>(), HasSubstr("no straight move leads there"));
}

/// Robots go into their docks round by round. In one round, wherever they are, one robot gets another goal,
/// and the other robot gets none.
void live(Json request, double step, Json how, int interrupted) {
  for (int round = 0; round < 10; ++round) {
    const Json answer = solved(request);
    how.erase("goals");
    if (round == interrupted) {
      how["goals"] = {{{"robot", "a"}, {"goals", Json::array({pose(1.0, 2.0)})}},
                      {{"robot", "b"}, {"goals", Json::array()}}};
    }
    request = advanced(request, answer, step, how);
    EXPECT_FALSE(request.contains("unavoidable"));
    EXPECT_FALSE(request["options"].contains("start_overlap"));
  }
}

TEST(GoalOverlap, GoesOnRoundAfterRound) {
  for (const Json& how :
       {Json::object(), Json{{"commit", 0.0}}, Json{{"commit", 0.6}}, Json{{"commit", 3.0}}}) {
    for (const bool brakes : {false, true}) {
      for (int interrupted = 2; interrupted < 9; ++interrupted) {
        Json request = hall();
        add(request, "a", pose(1.75, 1.0), pose(3.0, 0.25));
        add(request, "b", pose(4.25, 1.0), pose(2.3, 0.25));
        if (brakes) request["robot_defaults"]["stop_distance"] = 0.2;
        SCOPED_TRACE(testing::Message() << how << ", brakes " << brakes << ", round " << interrupted);
        live(request, 0.47, how, interrupted);
      }
    }
  }
}

}  // namespace TEST_FILE
}  // namespace fleetplan::api
