// Invalid requests of fleets in motion.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

#include "tests/api/support/fault_case.h"
#include "tests/api/support/motion_requests.h"

namespace fleetplan::api {

namespace TEST_FILE {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Pair;

using Case = FaultCase;
Json& committed(Json& request, std::size_t index) { return request["robots"][0]["committed"][index]; }

void give_obstacle(Json& request, const std::function<void(Json&)>& modify) {
  request["obstacles"] = Json::array({obstacle()});
  modify(request["obstacles"][0]);
}

TEST(FaultsOfIdleRobots, AStartToReturnToIsReportedOnce) {
  Json request = swap_request();
  for (Json& robot : request["robots"]) {
    robot.erase("goal");
    robot["idle"] = "return";
  }
  Json outside = request;
  robot(outside, 1)["start"]["x"] = -1;
  EXPECT_THAT(brief(faults_of(outside.dump())), ElementsAre(Pair("/robots/1/start", "start_in_obstacle")));
  Json twice = request;
  robot(twice, 1)["start"] = robot(twice, 0)["start"];
  EXPECT_THAT(brief(faults_of(twice.dump())), ElementsAre(Pair("/robots/1/start", "starts_overlap")));
}

class OneFaultOfMotion : public testing::TestWithParam<Case> {};

TEST_P(OneFaultOfMotion, IsReportedAtItsPlace) { expect_one_fault(moving_request(), GetParam()); }

INSTANTIATE_TEST_SUITE_P(
    OfCommittedActions, OneFaultOfMotion,
    testing::Values(
        Case{"NotAnArray", [](Json& r) { robot(r, 0)["committed"] = 1; }, "/robots/0/committed", "wrong_type",
             "array"},
        Case{"PreviousIsNull", [](Json& r) { robot(r, 1)["previous"] = nullptr; }, "/robots/1/previous",
             "wrong_type", "null"},
        Case{"UnknownType", [](Json& r) { committed(r, 1)["type"] = "stop"; }, "/robots/0/committed/1/type",
             "unknown_value", "\"wait\""},
        Case{"NoHeading", [](Json& r) { committed(r, 0)["to"].erase("theta"); },
             "/robots/0/committed/0/to/theta", "missing", "theta"},
        Case{"NegativeTime", [](Json& r) { committed(r, 0)["t_start"] = -1; },
             "/robots/0/committed/0/t_start", "out_of_range", "seconds"},
        Case{"BeginsLate", [](Json& r) { committed(r, 0)["t_start"] = 0.01; },
             "/robots/0/committed/0/t_start", "discontinuity", "must start at 0 s"},
        Case{"GapInTime", [](Json& r) { committed(r, 1)["t_start"] = 2.5; }, "/robots/0/committed/1/t_start",
             "discontinuity", "Action 1 (from 0) starts at 2.5 s, but the action before ends at 2 s"},
        Case{"EndsBeforeItBegins", [](Json& r) { committed(r, 1)["t_end"] = 1.5; },
             "/robots/0/committed/1/t_end", "discontinuity", "before it starts"},
        Case{"BeginsElsewhere", [](Json& r) { robot(r, 0)["start"]["y"] = 1.25; },
             "/robots/0/committed/0/from", "discontinuity", "0.25 m off the robot's start"},
        Case{"BeginsWithAnotherHeading", [](Json& r) { robot(r, 0)["start"]["theta"] = 0.5; },
             "/robots/0/committed/0/from", "discontinuity", "0.5 rad off the robot's start"},
        Case{"GapInSpace", [](Json& r) { committed(r, 1)["from"] = committed(r, 1)["to"] = pose(3.5, 1.5); },
             "/robots/0/committed/1/from", "discontinuity", "1 m off where the action before ends"},
        Case{"WaitsButMoves", [](Json& r) { committed(r, 1)["to"] = pose(2.75, 1.5); },
             "/robots/0/committed/1/to", "discontinuity", "waits, but moves by 0.25 m"},
        Case{"TranslatesButTurns",
             [](Json& r) {
               robot(r, 0)["committed"].erase(1);
               committed(r, 0)["to"]["theta"] = 0.25;
             },
             "/robots/0/committed/0/to", "discontinuity", "translates, but turns by 0.25 rad"},
        Case{"TooFast", [](Json& r) { committed(r, 0)["t_end"] = committed(r, 1)["t_start"] = 1.0; },
             "/robots/0/committed/0", "speed", "translates 2 m in 1 s, but the robot's speed is 1 m/s"},
        Case{"TurnsTooFast",
             [](Json& r) {
               committed(r, 1)["type"] = "rotate";
               committed(r, 1)["to"]["theta"] = 2.25;
             },
             "/robots/0/committed/1", "speed", "rotates 2.25 rad in 1 s, but the robot's speed is 2 rad/s"},
        Case{"Sideways",
             [](Json& r) {
               robot(r, 0)["committed"].erase(1);
               committed(r, 0)["t_end"] = 4.0;
               committed(r, 0)["to"]["y"] = 2.5;
             },
             "/robots/0/committed/0", "speed", "1 m sideways"},
        Case{"SidewaysByTheHeadingGiven", [](Json& r) { committed(r, 0)["from"]["theta"] = 4.9e-7; },
             "/robots/0/committed/0", "speed", "m sideways"},
        Case{"GoalOfATranslation", [](Json& r) { committed(r, 0)["goal"] = 0; }, "/robots/0/committed/0/goal",
             "unknown_key", "wait actions only"},
        Case{"OfPrevious",
             [](Json& r) {
               robot(r, 0)["previous"] = two_actions();
               robot(r, 0)["previous"][1]["t_start"] = 2.5;
             },
             "/robots/0/previous/1/t_start", "discontinuity", "contiguous in time"}),
    [](const auto& one) { return one.param.name; });

INSTANTIATE_TEST_SUITE_P(
    OfGoals, OneFaultOfMotion,
    testing::Values(Case{"GoalAndGoals", [](Json& r) { robot(r, 0)["goals"] = Json::array(); },
                         "/robots/0/goals", "duplicate", "both goal and goals"},
                    Case{"NegativeService", [](Json& r) { robot(r, 0)["goal"]["service"] = -1; },
                         "/robots/0/goal/service", "out_of_range", "seconds"},
                    Case{"DueAsText", [](Json& r) { robot(r, 0)["goal"]["due"] = "noon"; },
                         "/robots/0/goal/due", "wrong_type", "number"},
                    Case{"DueTooLate", [](Json& r) { robot(r, 0)["goal"]["due"] = 1e9; },
                         "/robots/0/goal/due", "out_of_range", "seconds"},
                    Case{"DueTooEarly",
                         [](Json& r) {
                           robot(r, 0)["goal"]["not_before"] = 20;
                           robot(r, 0)["goal"]["due"] = 19.5;
                         },
                         "/robots/0/goal/due", "out_of_range",
                         "due at 19.5 s, before its not_before, 20 s; make due at least not_before"},
                    Case{"NoWeight", [](Json& r) { robot(r, 0)["weight"] = 0; }, "/robots/0/weight",
                         "out_of_range", "0.001"},
                    Case{"IdleMistyped", [](Json& r) { robot(r, 0)["idle"] = "yields"; }, "/robots/0/idle",
                         "unknown_value", "did you mean \"yield\"?"},
                    Case{"IdleIsTrue", [](Json& r) { robot(r, 0)["idle"] = true; }, "/robots/0/idle",
                         "wrong_type", "\"stay\", \"yield\" or \"return\""},
                    Case{"ReturnsToTheGoalOfAnother",
                         [](Json& r) {
                           robot(r, 1).erase("goal");
                           robot(r, 1)["idle"] = "return";
                           robot(r, 0)["goal"] = robot(r, 1)["start"];
                         },
                         "/robots/1/start", "goals_overlap", "overlap"},
                    Case{"WeightOfDefaults", [](Json& r) { r["robot_defaults"]["weight"] = 2; },
                         "/robot_defaults/weight", "unknown_key", "weight"},
                    Case{"NoRadius", [](Json& r) { robot(r, 0)["goal"]["radius_after"] = 0.0; },
                         "/robots/0/goal/radius_after", "out_of_range", "metres"},
                    Case{"RadiusOfAnotherType", [](Json& r) { robot(r, 0)["goal"]["radius_after"] = "big"; },
                         "/robots/0/goal/radius_after", "wrong_type", "number"},
                    Case{"LoadThatDoesNotFit", [](Json& r) { robot(r, 0)["goal"]["radius_after"] = 2.0; },
                         "/robots/0/goal", "goal_in_obstacle", "(radius 2 m)"},
                    Case{"UnknownMember", [](Json& r) { robot(r, 0)["goal"]["notBefore"] = 1; },
                         "/robots/0/goal/notBefore", "unknown_key", "did you mean \"not_before\"?"}),
    [](const auto& one) { return one.param.name; });

Case of_obstacle(const std::string& name, const std::function<void(Json&)>& modify,
                 const std::string& pointer, const std::string& code, const std::string& detail) {
  return {name, [modify](Json& r) { give_obstacle(r, modify); }, "/obstacles/0" + pointer, code, detail};
}

INSTANTIATE_TEST_SUITE_P(
    OfObstacles, OneFaultOfMotion,
    testing::Values(
        Case{"NotAnArray", [](Json& r) { r["obstacles"] = 1; }, "/obstacles", "wrong_type", "array"},
        of_obstacle(
            "NoMotion", [](Json& o) { o.erase("motion"); }, "/motion", "missing", "give a list of"),
        of_obstacle(
            "EmptyMotion", [](Json& o) { o["motion"] = Json::array(); }, "/motion", "empty", "one entry"),
        of_obstacle(
            "NoRadius", [](Json& o) { o.erase("radius"); }, "/radius", "missing", "radius"),
        of_obstacle(
            "IdOfARobot", [](Json& o) { o["id"] = "b"; }, "/id", "duplicate",
            "Robot 1 and obstacle 0 (from 0) both have the id \"b\""),
        of_obstacle(
            "After", [](Json& o) { o["after"] = "stops"; }, "/after", "unknown_value",
            "\"leaves\" or \"stays\""),
        of_obstacle(
            "UnsortedTimes", [](Json& o) { o["motion"][0]["t"] = 11; }, "/motion/1/t", "out_of_range",
            "greater than that of the entry before, 11, not 10"),
        of_obstacle(
            "SameTime", [](Json& o) { o["motion"][0]["t"] = 10; }, "/motion/1/t", "out_of_range",
            "give each time once"),
        of_obstacle(
            "TooFast", [](Json& o) { o["motion"][1]["t"] = 1e-3; }, "/motion/1", "speed", "1000 m/s")),
    [](const auto& one) { return one.param.name; });

INSTANTIATE_TEST_SUITE_P(
    OfOptions, OneFaultOfMotion,
    testing::Values(Case{"Replan", [](Json& r) { r["options"]["replan"] = "none"; }, "/options/replan",
                         "unknown_value", "\"all\" or \"where_needed\""},
                    Case{"InvalidRobots", [](Json& r) { r["options"]["invalid_robots"] = "ignore"; },
                         "/options/invalid_robots", "unknown_value", "\"refuse\" or \"report\""},
                    Case{"HorizonNow", [](Json& r) { r["options"]["horizon"] = 0; }, "/options/horizon",
                         "out_of_range", "seconds"},
                    Case{"HorizonInWords", [](Json& r) { r["options"]["horizon"] = "20"; },
                         "/options/horizon", "wrong_type", "number"},
                    Case{"NegativeMargin", [](Json& r) { r["options"]["interval_margin"] = -1; },
                         "/options/interval_margin", "out_of_range", "seconds"},
                    Case{"NegativeOverlap", [](Json& r) { r["options"]["start_overlap"] = -1; },
                         "/options/start_overlap", "out_of_range", "metres"},
                    Case{"NegativeOverlapAtGoals", [](Json& r) { r["options"]["goal_overlap"] = -1; },
                         "/options/goal_overlap", "out_of_range", "metres"}),
    [](const auto& one) { return one.param.name; });

TEST(MotionFaults, ReportMoreThanTheLimitsAllow) {
  Json request = moving_request();
  robot(request, 1)["previous"] = Json::array();
  robot(request, 1).erase("goal");
  robot(request, 1)["goals"] = {{{"x", 7.5}, {"y", 0.5}}, {{"x", 0.5}, {"y", 1.5}}};
  request["obstacles"] = Json::array({obstacle()});
  Limits limits;
  limits.max_goals = limits.max_actions = limits.max_obstacle_entries = 2;
  limits.max_obstacles = 1;
  EXPECT_THAT(brief_faults_of(request, limits), IsEmpty());
  limits.max_goals = limits.max_actions = limits.max_obstacle_entries = 1;
  EXPECT_THAT(brief_faults_of(request, limits), ElementsAre(Pair("/robots/0/committed", "out_of_range"),
                                                            Pair("/robots/1/goals", "out_of_range"),
                                                            Pair("/obstacles/0/motion", "out_of_range")));
  limits = {};
  limits.max_obstacles = 0;
  EXPECT_THAT(brief_faults_of(request, limits), ElementsAre(Pair("/obstacles", "out_of_range")));
}

TEST(MotionFaults, AcceptMotionThatIsSlowerThanTheRobotAndBackwards) {
  Json request = moving_request();
  robot(request, 0)["start"]["theta"] = 3.0;
  robot(request, 0)["committed"] = {
      action("rotate", 0.0, 5.0, pose(0.5, 1.5, 3.0), pose(0.5, 1.5, -3.141592653589793)),
      action("translate", 5.0, 9.0, pose(0.5, 1.5, 3.141592653589793), pose(1.5, 1.5, 3.141592653589793))};
  EXPECT_THAT(brief_faults_of(request), IsEmpty());
}

}  // namespace TEST_FILE

}  // namespace fleetplan::api
