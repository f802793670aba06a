// Requests with the typical mistakes: what their faults and warnings say about the cause.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/api/support/requests.h"
#include "tests/support/unbounded_work.h"

namespace fleetplan::api {
namespace TEST_FILE {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

Json at(double x, double y) { return {{"x", x}, {"y", y}}; }

/// A hall of 8 x 5 m at (-1, 10) in the world. Its lower rows are walls, except for a bay at the left.
Json hall_request() {
  Json request = swap_request();
  request["map"] = Json::parse(R"({"resolution": 0.5, "origin": {"x": -1.0, "y": 10.0}, "rows": [
      "................", "................", "................", "................", "................",
      "................", "................", "....############", "....############", "....############"]})");
  request["robots"][0]["start"] = at(-0.5, 14.5);
  request["robots"][0]["goal"] = at(6.5, 14.5);
  request["robots"][1]["start"] = at(6.5, 13.9);
  request["robots"][1]["goal"] = at(0.0, 13.0);
  return request;
}

std::string first_detail(const Json& request) {
  const auto faults = faults_of(request.dump());
  return faults.empty() ? "" : faults.front().detail;
}

std::vector<std::string> warnings_of(const Json& request) {
  const auto parsed = parse_request(request.dump(), {}, unbounded_work());
  return parsed ? parsed->warnings : std::vector<std::string>{"refused: " + parsed.failure().detail};
}

TEST(Mistakes, HallIsValidWithoutThem) { EXPECT_THAT(warnings_of(hall_request()), IsEmpty()); }

TEST(Mistakes, OfAPoseOutsideTheMapTellItsSize) {
  Json request = hall_request();
  request["robots"][1]["goal"] = at(60.5, 12.0);
  EXPECT_THAT(
      first_detail(request),
      AllOf(
          HasSubstr("The goal of robot \"b\" is at (60.5, 12), outside the map, which reaches from -1 to 7 m "
                    "in x and from 10 to 15 m in y."),
          HasSubstr("correct the origin"), Not(HasSubstr("overlaps"))));
  EXPECT_EQ(faults_of(request.dump()).front().code, "goal_in_obstacle");
}

TEST(Mistakes, OfUnitsAreNamed) {
  Json request = hall_request();
  request["map"].erase("origin");
  request["robots"][0]["start"] = at(4000.0, 2500.0);
  EXPECT_THAT(first_detail(request), HasSubstr("in millimetres it would be on the map"));
  request["robots"][0]["start"] = at(400.0, 250.0);
  EXPECT_THAT(first_detail(request), HasSubstr("in centimetres it would be on the map"));
  request["robots"][0]["start"] = at(14.0, 9.0);
  EXPECT_THAT(first_detail(request), HasSubstr("in pixels of 0.5 m it would be on the map"));
}

TEST(Mistakes, OfUnitsAreNotNamedWhereTheDiskWouldNotFit) {
  Json request = hall_request();
  request["robots"][0]["start"] = at(0.7, 0.0);
  EXPECT_THAT(first_detail(request), AllOf(HasSubstr("outside the map"), Not(HasSubstr("pixels")),
                                           HasSubstr("Move it onto the map")));
}

TEST(Mistakes, OfPosesUpsideDownAreNamed) {
  Json request = hall_request();
  for (Json& robot : request["robots"]) {
    for (const char* pose : {"start", "goal"}) robot[pose]["y"] = 25.0 - robot[pose]["y"].get<double>();
  }
  const auto faults = faults_of(request.dump());
  ASSERT_GE(faults.size(), 2u);
  EXPECT_THAT(faults[0].detail,
              AllOf(HasSubstr("does not fit"), HasSubstr("With y mirrored, all starts and goals")));
  EXPECT_THAT(faults[1].detail, Not(HasSubstr("mirrored")));
}

TEST(Mistakes, OfOnePoseAreNotCalledUpsideDown) {
  Json request = hall_request();
  request["robots"][0]["start"] = at(5.0, 10.5);
  EXPECT_THAT(first_detail(request), Not(HasSubstr("mirrored")));
}

TEST(Mistakes, OfDiametersAreNamed) {
  Json request = hall_request();
  request["robot_defaults"]["radius"] = 0.8;  // the centres are 0.5 m from the walls
  EXPECT_THAT(first_detail(request), HasSubstr("is radius given as the diameter?"));
  request["robot_defaults"]["radius"] = 2.5;
  EXPECT_THAT(first_detail(request), Not(HasSubstr("diameter")));
}

TEST(Mistakes, OfOneRadiusAmongManyAreNotCalledDiameters) {
  Json request = hall_request();
  for (const char* id : {"c", "d", "e"}) {
    const double x = 1.0 + (id[0] - 'c');
    request["robots"].push_back({{"id", id}, {"start", at(x, 14.0)}});
  }
  request["robots"][0]["radius"] = 0.8;
  EXPECT_THAT(first_detail(request), AllOf(HasSubstr("does not fit"), Not(HasSubstr("diameter"))));
}

TEST(Mistakes, OfDegreesAreWarnings) {
  Json request = hall_request();
  request["robots"][0]["start"]["theta"] = 6.2;
  request["robots"][0]["goal"]["theta"] = -3.2;
  EXPECT_THAT(warnings_of(request), IsEmpty());
  request["robots"][0]["start"]["theta"] = 90;
  request["robots"][1]["goal"]["theta"] = -180;
  EXPECT_THAT(
      warnings_of(request),
      ElementsAre("The heading at the start of robot \"a\" is 90 rad (and 1 more like it), more than a whole "
                  "turn. Headings are in radians: is it in degrees?"));
}

TEST(Mistakes, OfSpeedsAreWarnings) {
  Json request = hall_request();
  request["robots"][1]["angular_speed"] = 60;
  request["robots"][1]["linear_speed"] = 500;
  EXPECT_THAT(
      warnings_of(request),
      ElementsAre(
          AllOf(HasSubstr("angular speed of robot \"b\" is 60 rad/s"), HasSubstr("degrees per second?")),
          AllOf(HasSubstr("linear speed of robot \"b\" is 500 m/s"), HasSubstr("millimetres"))));
}

TEST(Mistakes, OfTheHeadingOfAZoneAreWarnings) {
  Json request = hall_request();
  request["zones"] = Json::parse(R"([{"id": "way", "type": "one_way", "heading": 90, "half_angle": 1.5,
      "polygon": [{"x": 0, "y": 14}, {"x": 1, "y": 14}, {"x": 1, "y": 15}]}])");
  EXPECT_THAT(warnings_of(request), ElementsAre(HasSubstr("heading of zone \"way\" is 90 rad, more than")));
}

}  // namespace TEST_FILE
}  // namespace fleetplan::api
