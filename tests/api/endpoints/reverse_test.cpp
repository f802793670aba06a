// Robots that translate backwards, from the request to the next moment.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "api/endpoints/endpoints.h"
#include "tests/api/support/fault_case.h"
#include "tests/api/support/motion_requests.h"

namespace fleetplan::api {
namespace TEST_FILE {

using testing::HasSubstr;

/// Robot "a" looks away from its goal, in a corridor.
Json backing_request() {
  return Json::parse(R"({
    "map": {"rows": ["........."], "origin": {"x": 0.1, "y": 0.2}},
    "robot_defaults": {"radius": 0.3, "linear_speed": 1.0, "angular_speed": 0.5, "may_reverse": true},
    "robots": [{"id": "a", "start": {"x": 6.6, "y": 0.7, "theta": 0.0}, "goal": {"x": 0.6, "y": 0.7}}]})");
}

Json answered(const Reply& reply) {
  EXPECT_EQ(reply.status, 200) << reply.body;
  return json_of(reply);
}

TEST(Reverse, ThePlanHasATranslationBackwards) {
  const Json answer = answered(plan_endpoint(backing_request().dump(), {}));
  const Json& actions = answer["plans"][0]["actions"];
  ASSERT_EQ(actions.size(), 1U);
  EXPECT_EQ(actions[0]["type"], "translate");
  EXPECT_EQ(actions[0]["reverse"], true);
  EXPECT_EQ(actions[0]["to"]["theta"], 0.0);
}

TEST(Reverse, ARobotThatMayNotTurns) {
  Json request = backing_request();
  request["robots"][0]["may_reverse"] = false;
  const Json answer = answered(plan_endpoint(request.dump(), {}));
  ASSERT_EQ(answer["plans"][0]["actions"].size(), 2U);
  EXPECT_FALSE(answer["plans"][0]["actions"][1].contains("reverse"));
}

TEST(Reverse, ThePlanIsValidForRobotsThatMayOnly) {
  Json request = backing_request();
  request["plans"] = answered(plan_endpoint(request.dump(), {}))["plans"];
  EXPECT_EQ(answered(validate_endpoint(request.dump(), {}))["valid"], true);
  request["robots"][0]["may_reverse"] = false;
  const Json verdict = answered(validate_endpoint(request.dump(), {}));
  ASSERT_EQ(verdict["violations"].size(), 1U);
  EXPECT_EQ(verdict["violations"][0]["kind"], "speed");
}

TEST(Reverse, AMoveBackwardsUnderWayGoesOn) {
  const Json request = backing_request();
  const Json answer = answered(plan_endpoint(request.dump(), {}));
  const Json body = {{"request", request}, {"plans", answer["plans"]}, {"at", 2.0}};
  const Json next = answered(advance_endpoint(body.dump(), {}));
  EXPECT_EQ(next["robots"][0]["committed"][0]["reverse"], true);
  EXPECT_EQ(next["robots"][0]["previous"][0]["reverse"], true);
  EXPECT_EQ(next["robot_defaults"]["may_reverse"], true);
  const Json again = answered(plan_endpoint(next.dump(), {}));
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
