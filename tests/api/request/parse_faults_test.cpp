// Invalid requests, with one fault each and with several.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

#include "api/request/parse_request.h"
#include "tests/api/support/fault_case.h"
#include "tests/api/support/requests.h"
#include "tests/support/unbounded_work.h"

namespace fleetplan::api {
namespace TEST_FILE {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Pair;

using Case = FaultCase;

class OneFault : public testing::TestWithParam<Case> {};

TEST_P(OneFault, IsReportedAtItsPlace) { expect_one_fault(swap_request(), GetParam()); }

Json at(double x, double y) { return {{"x", x}, {"y", y}}; }
Json only_x(double x) { return {{"x", x}}; }

INSTANTIATE_TEST_SUITE_P(OfTheDocument, OneFault,
                         testing::Values(Case{"Array", [](Json& r) { r = Json::array(); }, "", "wrong_type",
                                              "must be an object, not an array"},
                                         Case{"NoMap", [](Json& r) { r.erase("map"); }, "/map", "missing",
                                              "map is missing"},
                                         Case{"NoRobots", [](Json& r) { r.erase("robots"); }, "/robots",
                                              "missing", "robots is missing"},
                                         Case{"UnknownKey", [](Json& r) { r["option"] = 1; }, "/option",
                                              "unknown_key", "did you mean \"options\"?"},
                                         Case{"UnknownKeyEscaped", [](Json& r) { r["a/b~c"] = 1; },
                                              "/a~1b~0c", "unknown_key", "known members:"}),
                         [](const auto& one) { return one.param.name; });

INSTANTIATE_TEST_SUITE_P(
    OfTheMap, OneFault,
    testing::Values(
        Case{"NotAnObject", [](Json& r) { r["map"] = "..."; }, "/map", "wrong_type", "the string \"...\""},
        Case{"NoRows", [](Json& r) { r["map"].erase("rows"); }, "/map/rows", "missing",
             "one string for each"},
        Case{"RowsAreAString", [](Json& r) { r["map"]["rows"] = "..."; }, "/map/rows", "wrong_type", "array"},
        Case{"RowsAreEmpty", [](Json& r) { r["map"]["rows"] = Json::array(); }, "/map/rows", "empty",
             "one row"},
        Case{"RowIsEmpty", [](Json& r) { r["map"]["rows"][2] = ""; }, "/map/rows/2", "empty", "Row 2"},
        Case{"RowIsANumber", [](Json& r) { r["map"]["rows"][1] = 5; }, "/map/rows/1", "wrong_type", "not 5"},
        Case{"RowIsShorter", [](Json& r) { r["map"]["rows"][3] = "...."; }, "/map/rows/3", "bad_map_row",
             "has 4 cells, but row 0 has 9"},
        Case{"RowHasAnUnknownCharacter", [](Json& r) { r["map"]["rows"][2] = "...é....."; }, "/map/rows/2",
             "bad_map_row", "\"é\" in column 3"},
        Case{"ResolutionIsZero", [](Json& r) { r["map"]["resolution"] = 0; }, "/map/resolution",
             "out_of_range", "from 1e-04 to 1e+06 metres, not 0"},
        Case{"ResolutionIsText", [](Json& r) { r["map"]["resolution"] = "1"; }, "/map/resolution",
             "wrong_type", "must be a number"},
        Case{"OriginLacksY", [](Json& r) { r["map"]["origin"] = only_x(1); }, "/map/origin/y", "missing",
             "y"},
        Case{"OriginIsFar", [](Json& r) { r["map"]["origin"] = at(1e10, 0); }, "/map/origin/x",
             "out_of_range", "metres"},
        Case{"UnknownKey", [](Json& r) { r["map"]["row"] = 1; }, "/map/row", "unknown_key", "\"rows\""}),
    [](const auto& one) { return one.param.name; });

INSTANTIATE_TEST_SUITE_P(
    OfTheRobots, OneFault,
    testing::Values(
        Case{"None", [](Json& r) { r["robots"] = Json::array(); }, "/robots", "empty", "at least one"},
        Case{"NotAnArray", [](Json& r) { r["robots"] = Json::object(); }, "/robots", "wrong_type", "array"},
        Case{"NotAnObject", [](Json& r) { robot(r, 1) = 7; }, "/robots/1", "wrong_type", "not 7"},
        Case{"NoId", [](Json& r) { robot(r, 0).erase("id"); }, "/robots/0/id", "missing", "id"},
        Case{"EmptyId", [](Json& r) { robot(r, 0)["id"] = ""; }, "/robots/0/id", "empty", "empty"},
        Case{"LongId", [](Json& r) { robot(r, 0)["id"] = std::string(257, 'x'); }, "/robots/0/id",
             "out_of_range", "at most 256 characters, not 257"},
        Case{"IdIsANumber", [](Json& r) { robot(r, 0)["id"] = 1; }, "/robots/0/id", "wrong_type", "string"},
        Case{"IdTwice", [](Json& r) { robot(r, 1)["id"] = "a"; }, "/robots/1/id", "duplicate",
             "Robots 0 and 1"},
        Case{"NoStart", [](Json& r) { robot(r, 0).erase("start"); }, "/robots/0/start", "missing", "start"},
        Case{"NoX", [](Json& r) { robot(r, 0)["start"].erase("x"); }, "/robots/0/start/x", "missing", "x"},
        Case{"GoalIsNull", [](Json& r) { robot(r, 1)["goal"] = nullptr; }, "/robots/1/goal", "wrong_type",
             "must be an object, not null"},
        Case{"ThetaIsNull", [](Json& r) { robot(r, 1)["goal"]["theta"] = nullptr; }, "/robots/1/goal/theta",
             "wrong_type", "omit it"},
        Case{"RadiusIsNegative", [](Json& r) { robot(r, 0)["radius"] = -1; }, "/robots/0/radius",
             "out_of_range", "not -1"},
        Case{"DefaultSpeedIsZero", [](Json& r) { r["robot_defaults"]["linear_speed"] = 0; },
             "/robot_defaults/linear_speed", "out_of_range", "metres per second"},
        Case{"UnknownDefault", [](Json& r) { r["robot_defaults"]["speed"] = 1; }, "/robot_defaults/speed",
             "unknown_key", "\"linear_speed\""},
        Case{"UnknownKey", [](Json& r) { robot(r, 1)["linearSpeed"] = 1; }, "/robots/1/linearSpeed",
             "unknown_key", "did you mean \"linear_speed\"?"}),
    [](const auto& one) { return one.param.name; });

INSTANTIATE_TEST_SUITE_P(
    OfTheGeometry, OneFault,
    testing::Values(Case{"StartInAWall", [](Json& r) { robot(r, 0)["start"] = at(4.5, 1.5); },
                         "/robots/0/start", "start_in_obstacle", "robot \"a\" does not fit"},
                    Case{"GoalOutsideTheMap", [](Json& r) { robot(r, 1)["goal"]["x"] = -3; },
                         "/robots/1/goal", "goal_in_obstacle",
                         "outside the map, which reaches from 0 to 9 m"},
                    Case{"StartsOverlap", [](Json& r) { robot(r, 1)["start"] = at(0.5, 2.0); },
                         "/robots/1/start", "starts_overlap",
                         "\"a\" and \"b\" overlap: the gap between their disks is -0.1 m"},
                    Case{"GoalsOverlap", [](Json& r) { robot(r, 1)["goal"] = at(8.5, 2.0); },
                         "/robots/1/goal", "goals_overlap", "-0.1 m"}),
    [](const auto& one) { return one.param.name; });

Case option(const std::string& name, const std::string& key, const Json& value, const std::string& code,
            const std::string& detail) {
  return {name, [=](Json& r) { r["options"][key] = value; }, "/options/" + key, code, detail};
}

INSTANTIATE_TEST_SUITE_P(
    OfTheOptions, OneFault,
    testing::Values(
        option("UnknownKey", "inflate", 1, "unknown_key", "did you mean \"inflation\"?"),
        option("BudgetBelowOne", "time_budget_ms", 0.5, "out_of_range", "at least 1 milliseconds, not 0.5"),
        option("BudgetIsText", "time_budget_ms", "5s", "wrong_type", "must be a number"),
        option("Mode", "mode", "fast", "unknown_value", "\"first\" or \"anytime\", not \"fast\""),
        option("ModeMistyped", "mode", "anytimes", "unknown_value", "did you mean \"anytime\"?"),
        option("ObjectiveIsANumber", "objective", 1, "wrong_type", "\"makespan\" or \"tardiness\""),
        option("Priority", "priority", "x", "unknown_value", "\"as_listed\" or \"random\""),
        option("Reordering", "reordering", "x", "unknown_value", "\"raise_failed\", \"random\" or \"none\""),
        option("SeedIsNegative", "seed", -1, "out_of_range", "0 to 18446744073709551615, not -1"),
        option("SeedIsAFraction", "seed", 0.5, "wrong_type", "whole number"),
        option("SeedIsTooLarge", "seed", 1e20, "out_of_range", "0 to 18446744073709551615"),
        option("NegativeInterval", "start_safe_interval", -1, "out_of_range", "seconds"),
        option("NegativeInflation", "inflation", -0.1, "out_of_range", "metres"),
        option("NegativeWait", "wait_before_move", -1, "out_of_range", "seconds"),
        option("AnyAngleIsANumber", "any_angle", 1, "wrong_type", "true or false, not 1"),
        option("Connectivity", "connectivity", 6, "out_of_range", "4, 8, 16 or 32, not 6"),
        option("ConnectivityIsText", "connectivity", "8", "wrong_type", "4, 8, 16 or 32"),
        option("Iterations", "max_iterations", -5, "out_of_range", "not -5"),
        option("SpacingIsZero", "lattice_spacing", 0, "out_of_range", "metres"),
        option("SpacingIsText", "lattice_spacing", "auto", "wrong_type", "must be a number"),
        option("SpacingIsTooLarge", "lattice_spacing", 1000, "out_of_range",
               "at most twice its shorter side"),
        option("SpacingIsTooSmall", "lattice_spacing", 0.0002, "out_of_range", "Use a larger spacing"),
        Case{"NotAnObject", [](Json& r) { r["options"] = nullptr; }, "/options", "wrong_type", "null"}),
    [](const auto& one) { return one.param.name; });

TEST(Faults, ReportATooLargeNumberAtItsPlace) {
  std::string body = swap_request().dump();
  body.replace(body.find("8.5"), 3, "1e999");
  const auto faults = faults_of(body);
  EXPECT_THAT(brief(faults), ElementsAre(Pair("/robots/0/goal/x", "out_of_range")));
  EXPECT_THAT(faults.front().detail, HasSubstr("too large"));
}

TEST(Faults, ReportMembersMissingInRobotAndDefaults) {
  Json request = swap_request();
  request.erase("robot_defaults");
  robot(request, 0)["radius"] = 0.3;
  EXPECT_THAT(
      brief_faults_of(request),
      ElementsAre(Pair("/robots/0/linear_speed", "missing"), Pair("/robots/0/angular_speed", "missing"),
                  Pair("/robots/1/radius", "missing"), Pair("/robots/1/linear_speed", "missing"),
                  Pair("/robots/1/angular_speed", "missing")));
}

TEST(Faults, ReportSizesBeyondTheLimits) {
  Limits limits;
  limits.max_cells = 35;
  limits.max_robots = 1;
  EXPECT_THAT(brief_faults_of(swap_request(), limits),
              ElementsAre(Pair("/map/rows", "out_of_range"), Pair("/robots", "out_of_range")));
  limits = {};
  limits.max_cells = 36;
  limits.max_robots = 2;
  EXPECT_THAT(brief_faults_of(swap_request(), limits), IsEmpty());
  limits.max_cells = 35;
  EXPECT_THAT(detail_of(swap_request(), limits), HasSubstr("9 x 4 = 36 cells"));
}

TEST(Faults, AreReportedTogetherInTheOrderOfTheDocument) {
  const std::string body = R"({
    "options": {"mode": "slow", "seed": 1, "seed": 2},
    "robots": [
      {"id": "a", "goal": {"x": 4.5, "y": 1.5}, "start": {"x": 0.5, "y": 1.5}},
      {"id": "broken", "start": {"x": "left", "y": 1}},
      {"id": "c", "start": {"x": 0.5, "y": 2.0}, "goal": {"x": 2.5, "y": 2.5}},
      {"goal": {"x": 2.5, "y": 2.5}, "start": {"x": 7.5, "y": 0.5}},
      {"id": "a", "start": {"x": 7.5, "y": 3.5}}],
    "map": {"rows": [".........", "....#....", "....#....", "........."], "colour": 3},
    "robot_defaults": {"radius": 0.3, "linear_speed": 1.0, "angular_speed": 2.0}
  })";
  EXPECT_THAT(brief(faults_of(body)),
              ElementsAre(Pair("/options/mode", "unknown_value"), Pair("/options/seed", "duplicate"),
                          Pair("/robots/1/start/x", "wrong_type"), Pair("/robots/3/id", "missing"),
                          Pair("/robots/4/id", "duplicate"), Pair("/map/colour", "unknown_key")));
}

TEST(Faults, OfOneRobotDoNotHideFaultsOfOthers) {
  Json request = swap_request();
  robot(request, 0)["start"] = {{"x", "left"}, {"y", 1}};
  robot(request, 1)["goal"] = at(4.5, 1.5);
  request["robots"].push_back(
      Json::parse(R"({"start": {"x": 8.5, "y": 2.0}, "goal": {"x": 2.5, "y": 2.5}, "linear_speed": -1})"));
  const auto faults = faults_of(request.dump());
  EXPECT_THAT(brief(faults),
              ElementsAre(Pair("/robots/0/start/x", "wrong_type"), Pair("/robots/1/goal", "goal_in_obstacle"),
                          Pair("/robots/2/start", "starts_overlap"),
                          Pair("/robots/2/linear_speed", "out_of_range"), Pair("/robots/2/id", "missing")));
  EXPECT_THAT(faults[2].detail, HasSubstr("\"b\" and number 2"));
}

TEST(Faults, AreListedUpToTwentyAndCounted) {
  Json request = swap_request();
  request["robots"] = Json::array();
  for (int index = 0; index < 150; ++index) request["robots"].push_back(1);
  const auto result = parse_request(request.dump(), {}, unbounded_work());
  const RequestError& error = result.failure();
  EXPECT_EQ(error.code, ErrorCode::invalid_request);
  EXPECT_EQ(error.faults.size(), 20U);
  EXPECT_EQ(error.faults.back().pointer, "/robots/19");
  EXPECT_THAT(error.detail, HasSubstr("150 faults"));
}

TEST(Faults, CountCharactersOfAnIdInsteadOfBytes) {
  Json request = swap_request();
  std::string id;
  for (int i = 0; i < 256; ++i) id += "ä";
  robot(request, 0)["id"] = id;
  EXPECT_THAT(brief_faults_of(request), IsEmpty());
}

TEST(Faults, ContainIdsInAnyLanguage) {
  Json request = swap_request();
  robot(request, 0)["id"] = "Wägelchen 🚚";
  robot(request, 1)["id"] = "Wägelchen 🚚";
  EXPECT_THAT(detail_of(request), HasSubstr("Wägelchen 🚚"));
}

TEST(Faults, DoNotIncludeRobotsInContact) {
  Json request = swap_request();
  robot(request, 1)["start"] = at(0.5, 2.1);
  EXPECT_THAT(brief_faults_of(request), IsEmpty());
}

TEST(Faults, OfPosesAreCountedBeyondThoseThatAreListed) {
  Json request = swap_request();
  request["robots"] = Json::array();
  for (int index = 0; index < 30; ++index) {
    request["robots"].push_back({{"id", std::to_string(index)}, {"start", {{"x", 0.5}, {"y", 0.5}}}});
  }
  const RequestError error = parse_request(request.dump(), {}, unbounded_work()).failure();
  EXPECT_EQ(error.faults.size(), 20U);
  EXPECT_EQ(error.faults_total, 30U * 29U / 2U) << "pairs";
}

TEST(Faults, OfHugeRobotsOnALargeBlockedMapAreFoundAtOnce) {
  Json request = swap_request();
  request["map"]["rows"] = std::vector<std::string>(1500, std::string(1500, '#'));
  request["robots"] = Json::array();
  for (int index = 0; index < 200; ++index) {
    request["robots"].push_back({{"id", std::to_string(index)},
                                 {"radius", 700.0},
                                 {"start", {{"x", 750.0}, {"y", 750.0}}},
                                 {"goal", {{"x", 751.0}, {"y", 750.0}}}});
  }
  const std::string body = request.dump();
  const auto begin = core::thread_cpu_time();
  EXPECT_GE(parse_request(body, {}, unbounded_work()).failure().faults_total, 400U);
  EXPECT_LT(core::thread_cpu_time() - begin, std::chrono::seconds(2)) << "4 ms for each pose otherwise";
}

}  // namespace TEST_FILE
}  // namespace fleetplan::api
