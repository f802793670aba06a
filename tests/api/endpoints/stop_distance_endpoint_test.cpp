// Robots that need some way to stop, in requests.

#include <gtest/gtest.h>

#include <string>

#include "api/endpoints/endpoints.h"
#include "tests/api/support/requests.h"

namespace fleetplan::api {
namespace TEST_FILE {

/// A robot that needs a metre to stop drives towards a robot that stands in a wide corridor.
Json towards_another(double stop_distance) {
  return {{"request", Json::parse(R"({
            "map": {"rows": ["..........", "..........", ".........."]},
            "robot_defaults": {"radius": 0.3, "linear_speed": 1.0, "angular_speed": 3.0, "stop_distance": )" +
                                  std::to_string(stop_distance) + R"(},
            "robots": [{"id": "a", "start": {"x": 0.5, "y": 1.5, "theta": 0}, "goal": {"x": 9.5, "y": 1.5}},
                       {"id": "b", "start": {"x": 4.5, "y": 1.5, "theta": 1.5}, "goal": {"x": 4.5, "y": 2.5}}]})")},
          {"plans", Json::parse(R"([
            {"robot": "a", "cost": 9, "actions": [{"type": "translate", "t_start": 0, "t_end": 9,
             "from": {"x": 0.5, "y": 1.5, "theta": 0}, "to": {"x": 9.5, "y": 1.5, "theta": 0}}]},
            {"robot": "b", "cost": 0, "actions": []}])")},
          {"at", 2.5},
          {"commit", 0.0}};
}

Json advanced_json(const Json& body) {
  const Reply reply = advance_endpoint(body.dump(), {});
  EXPECT_EQ(reply.status, 200) << reply.body;
  return json_of(reply);
}

TEST(StopDistance, IsOfTheRobotOrOfTheDefaults) {
  Json body = towards_another(1.0);
  EXPECT_EQ(advanced_json(body)["robots"][0]["committed"][0]["t_end"], 1.0);
  body["request"]["robots"][0]["stop_distance"] = 0.25;
  const Json next = advanced_json(body);
  EXPECT_EQ(next["robots"][0]["committed"][0]["t_end"], 0.25);
  EXPECT_EQ(next["robots"][0]["stop_distance"], 0.25);
  EXPECT_EQ(next["robot_defaults"]["stop_distance"], 1.0);
  EXPECT_FALSE(next.contains("unavoidable"));
}

TEST(StopDistance, ThoseThatCannotAvoidEachOtherAreNamedAndCanBePlanned) {
  Json body = towards_another(2.0);
  const Json next = advanced_json(body);
  ASSERT_EQ(next["unavoidable"].size(), 1U) << next;
  EXPECT_EQ(next["unavoidable"][0]["robots"], Json::parse(R"(["a", "b"])"));
  EXPECT_NEAR(next["unavoidable"][0]["t"].get<double>(), 0.9, 1e-5);
  const Json plan = json_of(plan_endpoint(next.dump(), {}));
  EXPECT_EQ(plan["status"], "solved") << "the other one leaves: " << plan;
  body["at"] = 3.2;
  const Reply late = plan_endpoint(advanced_json(body).dump(), {});
  EXPECT_EQ(late.status, 200) << late.body;
  EXPECT_EQ(json_of(late)["unavoidable"].size(), 1U) << late.body;
}

TEST(StopDistance, ARequestOfTwoThatCannotStopIsAccepted) {
  Json body = towards_another(3.0);
  Json& plan = body["plans"][1];
  plan["actions"] = Json::parse(R"([{"type": "translate", "t_start": 0, "t_end": 4,
    "from": {"x": 7.5, "y": 1.5, "theta": 3.141592653589793},
    "to": {"x": 3.5, "y": 1.5, "theta": 3.141592653589793}}])");
  plan["cost"] = 4;
  body["request"]["robots"][1]["start"] = plan["actions"][0]["from"];
  body["at"] = 2.0;
  const Json next = advanced_json(body);
  EXPECT_EQ(next["unavoidable"].size(), 1U) << next;
  EXPECT_EQ(plan_endpoint(next.dump(), {}).status, 200);
}

TEST(StopDistance, IsALength) {
  Json body = towards_another(1.0);
  body["request"]["robot_defaults"]["stop_distance"] = -1.0;
  const Reply reply = advance_endpoint(body.dump(), {});
  EXPECT_EQ(reply.status, 422);
  EXPECT_EQ(json_of(reply)["errors"][0]["pointer"], "/request/robot_defaults/stop_distance");
  EXPECT_EQ(json_of(reply)["errors"][0]["code"], "out_of_range");
}

}  // namespace TEST_FILE
}  // namespace fleetplan::api
