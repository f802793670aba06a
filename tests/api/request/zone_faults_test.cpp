// Zones of requests, and their faults.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/api/support/fault_case.h"
#include "tests/api/support/motion_requests.h"
#include "tests/support/base64.h"
#include "tests/support/unbounded_work.h"

namespace fleetplan::api {
namespace TEST_FILE {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Pair;

using Case = FaultCase;

Json corner(double x, double y) { return {{"x", x}, {"y", y}}; }

/// A blocked zone in the upper middle of the hall.
Json zone() {
  return {{"id", "ward"},
          {"type", "blocked"},
          {"polygon", {corner(3, 3), corner(6, 3), corner(6, 3.5), corner(3, 3.5)}}};
}

Json request_with_zone() {
  Json request = swap_request();
  request["zones"] = Json::array({zone()});
  return request;
}

Json& the_zone(Json& request) { return request["zones"][0]; }
Json& polygon(Json& request) { return the_zone(request)["polygon"]; }

TEST(Zones, AreReadInTheFrameOfTheMap) {
  Json request = request_with_zone();
  request["map"]["origin"] = {{"x", -1.0}, {"y", 0.5}};
  for (int k : {0, 1}) {
    for (const char* pose : {"start", "goal"}) {
      robot(request, k)[pose]["x"] = robot(request, k)[pose]["x"].get<double>() - 1.0;
      robot(request, k)[pose]["y"] = robot(request, k)[pose]["y"].get<double>() + 0.5;
    }
  }
  the_zone(request)["robots"] = {"b"};
  const auto read = parse_request(request.dump(), {}, unbounded_work());
  ASSERT_TRUE(read);
  ASSERT_EQ(read->problem.zones().size(), 1U);
  const core::Zone& zone = read->problem.zones()[0];
  EXPECT_EQ(zone.id, "ward");
  EXPECT_EQ(zone.polygon.at(0), core::Position(4.0, 2.5));
  EXPECT_THAT(zone.robots, ElementsAre(1U));
}

class OneFaultOfZones : public testing::TestWithParam<Case> {};

TEST_P(OneFaultOfZones, IsReportedAtItsPlace) { expect_one_fault(request_with_zone(), GetParam()); }

INSTANTIATE_TEST_SUITE_P(
    OfMembers, OneFaultOfZones,
    testing::Values(
        Case{"NotAList", [](Json& r) { r["zones"] = zone(); }, "/zones", "wrong_type", "array"},
        Case{"NotAnObject", [](Json& r) { r["zones"][0] = "ward"; }, "/zones/0", "wrong_type", "object"},
        Case{"NoId", [](Json& r) { the_zone(r).erase("id"); }, "/zones/0/id", "missing", "id"},
        Case{"NoType", [](Json& r) { the_zone(r).erase("type"); }, "/zones/0/type", "missing", "blocked"},
        Case{"UnknownType", [](Json& r) { the_zone(r)["type"] = "wall"; }, "/zones/0/type", "unknown_value",
             "\"blocked\""},
        Case{"UnknownMember", [](Json& r) { the_zone(r)["colour"] = "red"; }, "/zones/0/colour",
             "unknown_key", "colour"},
        Case{"NoPolygon", [](Json& r) { the_zone(r).erase("polygon"); }, "/zones/0/polygon", "missing",
             "list"},
        Case{"SameId", [](Json& r) { r["zones"].push_back(zone()); }, "/zones/1/id", "duplicate",
             "Zones 0 and 1 (from 0) both have the id \"ward\""},
        Case{"NoRobots", [](Json& r) { the_zone(r)["robots"] = Json::array(); }, "/zones/0/robots", "empty",
             "leave it out"},
        Case{"UnknownRobot",
             [](Json& r) {
               the_zone(r)["robots"] = {"a", "c"};
             },
             "/zones/0/robots/1", "unknown_robot", "no robot \"c\""},
        Case{"RobotTwice",
             [](Json& r) {
               the_zone(r)["robots"] = {"b", "b"};
             },
             "/zones/0/robots/1", "duplicate", "already in this list"}),
    [](const auto& one) { return one.param.name; });

INSTANTIATE_TEST_SUITE_P(
    OfPolygons, OneFaultOfZones,
    testing::Values(
        Case{"NoCorners", [](Json& r) { polygon(r) = Json::array(); }, "/zones/0/polygon", "bad_polygon",
             "at least 3 corners, not 0"},
        Case{"TwoCorners", [](Json& r) { polygon(r).erase(0), polygon(r).erase(0); }, "/zones/0/polygon",
             "bad_polygon", "at least 3 corners, not 2"},
        Case{"NoX", [](Json& r) { polygon(r)[1].erase("x"); }, "/zones/0/polygon/1/x", "missing", "x"},
        Case{"FarAway", [](Json& r) { polygon(r)[1]["x"] = 1e10; }, "/zones/0/polygon/1/x", "out_of_range",
             "metres"},
        Case{"CrossesItself", [](Json& r) { std::swap(polygon(r)[1], polygon(r)[2]); }, "/zones/0/polygon",
             "bad_polygon", "The sides that begin at the corners 0 and 2 (from 0) cross or touch"},
        Case{"TouchesItself", [](Json& r) { polygon(r).push_back(corner(4, 3)); }, "/zones/0/polygon",
             "bad_polygon", "cross or touch"},
        Case{"LeadsBack", [](Json& r) { polygon(r).insert(polygon(r).begin() + 2, corner(5, 3)); },
             "/zones/0/polygon", "bad_polygon", "cross or touch"},
        Case{"IsALine",
             [](Json& r) {
               polygon(r) = {corner(3, 3), corner(4, 3), corner(6, 3)};
             },
             "/zones/0/polygon", "bad_polygon", "cross or touch"},
        Case{"RepeatsACorner", [](Json& r) { polygon(r).insert(polygon(r).begin(), corner(3, 3)); },
             "/zones/0/polygon/1", "bad_polygon", "equals the one before"},
        Case{"RepeatsTheFirst", [](Json& r) { polygon(r).push_back(corner(3, 3)); }, "/zones/0/polygon/4",
             "bad_polygon", "closed"},
        Case{"TooManyCorners",
             [](Json& r) {
               polygon(r) = Json::array();
               for (int k = 0; k < 1001; ++k) polygon(r).push_back(corner(k, k * k));
             },
             "/zones/0/polygon", "out_of_range", "1001 corners; it may have 1000"}),
    [](const auto& one) { return one.param.name; });

INSTANTIATE_TEST_SUITE_P(
    OfPoses, OneFaultOfZones,
    testing::Values(Case{"StartInside",
                         [](Json& r) {
                           polygon(r) = {corner(0, 1), corner(2, 1), corner(2, 2)};
                           the_zone(r)["robots"] = {"a"};
                         },
                         "/robots/0/start", "start_in_obstacle", "overlaps the blocked zone \"ward\" by"},
                    Case{"GoalInside",
                         [](Json& r) {
                           polygon(r) = {corner(8, 1), corner(9, 1), corner(9, 2)};
                           the_zone(r)["robots"] = {"a"};
                         },
                         "/robots/0/goal", "goal_in_obstacle", "overlaps the blocked zone \"ward\" by"}),
    [](const auto& one) { return one.param.name; });

void make_speed(Json& request) {
  the_zone(request)["type"] = "speed";
  the_zone(request)["linear_speed"] = 0.5;
}

void make_one_way(Json& request) {
  the_zone(request)["type"] = "one_way";
  the_zone(request)["heading"] = 0.0;
  the_zone(request)["half_angle"] = 1.5;
}

/// Of the size of the hall: white, with two black cells and one of 50.
std::string pgm() {
  return "P2\n9 4\n255\n"
         "255 255 0 255 255 255 50 255 255\n"
         "255 255 0 255 255 255 255 255 255\n"
         "255 255 255 255 255 255 255 255 255\n"
         "255 255 255 255 255 255 255 255 255\n";
}

/// A mask instead of the polygon.
void make_mask(Json& request) {
  the_zone(request).erase("polygon");
  the_zone(request)["mask"] = {{"pgm", support::base64(pgm())}};
}

INSTANTIATE_TEST_SUITE_P(
    OfRules, OneFaultOfZones,
    testing::Values(Case{"SpeedOfBlocked", [](Json& r) { the_zone(r)["linear_speed"] = 1; },
                         "/zones/0/linear_speed", "unknown_key", "is for zones of the type speed only"},
                    Case{"HeadingOfSpeed", [](Json& r) { make_speed(r), the_zone(r)["heading"] = 1; },
                         "/zones/0/heading", "unknown_key", "is for zones of the type one_way only"},
                    Case{"NoSpeed", [](Json& r) { the_zone(r)["type"] = "speed"; }, "/zones/0/linear_speed",
                         "missing", "linear_speed, angular_speed or both"},
                    Case{"Standing", [](Json& r) { make_speed(r), the_zone(r)["linear_speed"] = 0; },
                         "/zones/0/linear_speed", "out_of_range", "metres per second"},
                    Case{"NoHeading", [](Json& r) { make_one_way(r), the_zone(r).erase("heading"); },
                         "/zones/0/heading", "missing", "direction of travel"},
                    Case{"NoHalfAngle", [](Json& r) { make_one_way(r), the_zone(r).erase("half_angle"); },
                         "/zones/0/half_angle", "missing", "how far from heading"},
                    Case{"WideHalfAngle", [](Json& r) { make_one_way(r), the_zone(r)["half_angle"] = 4; },
                         "/zones/0/half_angle", "out_of_range", "radians"}),
    [](const auto& one) { return one.param.name; });

INSTANTIATE_TEST_SUITE_P(
    OfMasks, OneFaultOfZones,
    testing::Values(Case{"AndPolygon",
                         [](Json& r) {
                           the_zone(r)["mask"] = {{"pgm", support::base64(pgm())}};
                         },
                         "/zones/0/polygon", "duplicate", "both a polygon and a mask"},
                    Case{"OfOneWay", [](Json& r) { make_one_way(r), make_mask(r); }, "/zones/0/mask",
                         "unknown_key", "blocked and speed only"},
                    Case{"OfAnotherSize",
                         [](Json& r) {
                           make_mask(r);
                           the_zone(r)["mask"]["pgm"] = support::base64("P2\n2 1\n255\n0 255\n");
                         },
                         "/zones/0/mask", "wrong_size",
                         "the map has 9 x 4 cells; give the resolution and the origin"},
                    Case{"WithABaseButBlocked",
                         [](Json& r) {
                           make_mask(r);
                           the_zone(r)["mask"]["base"] = 100;
                         },
                         "/zones/0/mask/base", "unknown_key", "of the type speed only"},
                    Case{"TurnedByAnyAngle",
                         [](Json& r) {
                           make_mask(r);
                           the_zone(r)["mask"]["origin"] = {0, 0, 1};
                         },
                         "/zones/0/mask/origin/2", "out_of_range", "a multiple of pi / 2"},
                    Case{"TooLarge",
                         [](Json& r) {
                           make_mask(r);
                           the_zone(r)["mask"]["resolution"] = 1e6;
                         },
                         "/zones/0/mask", "out_of_range", "at most 1e+06 m in each direction"},
                    Case{"NotAnImage", [](Json& r) { make_mask(r), the_zone(r)["mask"]["pgm"] = "UDU="; },
                         "/zones/0/mask/pgm", "bad_image", ""},
                    Case{"WithASpeed", [](Json& r) { make_speed(r), make_mask(r); }, "/zones/0/linear_speed",
                         "unknown_key", "the mask has the speeds"}),
    [](const auto& one) { return one.param.name; });

TEST(Zones, AreTheOccupiedCellsOfAMask) {
  Json request = request_with_zone();
  make_mask(request);
  const auto read = parse_request(request.dump(), {}, unbounded_work());
  ASSERT_TRUE(read);
  const auto& zones = read->problem.zones();
  ASSERT_EQ(zones.size(), 2U);  // two cells below each other are one part
  EXPECT_EQ(zones[0].id, zones[1].id);
  const auto& cells = zones[0].polygon.at(0).x() < 4.0 ? zones[0].polygon : zones[1].polygon;
  EXPECT_LT((cells.at(0) - core::Position(2.0, 2.0)).norm(), 1e-5);
  EXPECT_LT((cells.at(2) - core::Position(3.0, 4.0)).norm(), 1e-5);
}

TEST(Zones, LimitEachRobotToThePercentageOfASpeedMask) {
  Json request = request_with_zone();
  make_mask(request);
  the_zone(request)["type"] = "speed";
  the_zone(request)["mask"].update({{"mode", "raw"}, {"base", 0}, {"multiplier", 1}});
  robot(request, 1)["linear_speed"] = 2.0;
  const auto read = parse_request(request.dump(), {}, unbounded_work());
  ASSERT_TRUE(read);
  const auto& zones = read->problem.zones();
  ASSERT_EQ(zones.size(), 1U);  // black is 0 %, and white unknown
  EXPECT_NEAR(zones[0].linear_speed_for(1.0), 0.5, 1e-12);
  EXPECT_NEAR(zones[0].linear_speed_for(2.0), 1.0, 1e-12);
  EXPECT_THAT(zones[0].robots, IsEmpty());
}

TEST(ZoneFaults, NameTheZoneWhoseRuleCommittedMotionBreaks) {
  Json request = moving_request();
  request["zones"] = Json::array({zone()});
  polygon(request) = {corner(1, 1), corner(2, 1), corner(2, 2), corner(1, 2)};
  make_speed(request);
  const auto fast = faults_of(request.dump());
  EXPECT_THAT(brief(fast), ElementsAre(Pair("/robots/0/committed/0", "committed_in_zone")));
  EXPECT_THAT(fast.at(0).detail, HasSubstr("the rule of the zone \"ward\""));
  the_zone(request).erase("linear_speed");
  make_one_way(request);
  EXPECT_THAT(brief_faults_of(request), IsEmpty());
  the_zone(request)["heading"] = 3.0;
  EXPECT_THAT(brief_faults_of(request), ElementsAre(Pair("/robots/0/committed/0", "committed_in_zone")));
}

TEST(ZoneFaults, NameTheZoneThatCommittedMotionEnters) {
  Json request = moving_request();
  request["zones"] = Json::array({zone()});
  polygon(request) = {corner(1.5, 1), corner(2, 1), corner(2, 2)};
  const auto faults = faults_of(request.dump());
  EXPECT_THAT(brief(faults), ElementsAre(Pair("/robots/0/committed/0", "committed_collision")));
  EXPECT_THAT(faults.at(0).detail, HasSubstr("overlaps the blocked zone \"ward\""));
}

TEST(ZoneFaults, ReportMoreThanTheLimitsAllow) {
  Json request = request_with_zone();
  Limits limits;
  limits.max_zones = 1;
  limits.max_zone_corners = 4;
  EXPECT_THAT(brief_faults_of(request, limits), IsEmpty());
  limits.max_zone_corners = 3;
  EXPECT_THAT(brief_faults_of(request, limits), ElementsAre(Pair("/zones/0/polygon", "out_of_range")));
  limits.max_zones = 0;
  EXPECT_THAT(brief_faults_of(request, limits), ElementsAre(Pair("/zones", "out_of_range")));
}

TEST(ZoneFaults, ZonesBeyondTheLimitOfCornersAreLeftOut) {
  Json request = request_with_zone();
  for (const char* id : {"second", "third"}) {
    request["zones"].push_back(request["zones"][0]);
    request["zones"].back()["id"] = id;
  }
  Limits limits;
  limits.max_zone_corners = 4;
  EXPECT_THAT(brief_faults_of(request, limits), ElementsAre(Pair("/zones/1/polygon", "out_of_range")));
}

}  // namespace TEST_FILE
}  // namespace fleetplan::api
