// Numbers outside the ranges of real fleets are rejected with pointer, range and remedy.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <tuple>
#include <vector>

#include "api/endpoints/endpoints.h"
#include "tests/api/support/requests.h"

namespace fleetplan::api {
namespace TEST_FILE {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Pair;

Json with_robot(const char* trait, double value) {
  Json request = swap_request();
  request["robots"][0][trait] = value;
  return request;
}

Json with_option(const char* option, double value) {
  Json request = swap_request();
  request["options"][option] = value;
  return request;
}

TEST(Ranges, OfSpeedsAreThoseOfRealFleets) {
  for (const auto& [trait, least, most] :
       {std::tuple{"linear_speed", 1e-3, 1e3}, std::tuple{"angular_speed", 1e-3, 1e6}}) {
    for (const double valid : {least, most})
      EXPECT_THAT(brief_faults_of(with_robot(trait, valid)), IsEmpty());
    for (const double invalid : {0.9 * least, 1.1 * most}) {
      const std::string pointer = std::string("/robots/0/") + trait;
      EXPECT_THAT(brief_faults_of(with_robot(trait, invalid)), ElementsAre(Pair(pointer, "out_of_range")));
    }
  }
  EXPECT_THAT(detail_of(with_robot("angular_speed", 1e9)),
              HasSubstr("from 0.001 to 1e+06 radians per second"));
}

TEST(Ranges, OfTimesEndAtAHundredMillionSeconds) {
  for (const char* option : {"start_safe_interval", "wait_before_move"}) {
    EXPECT_THAT(brief_faults_of(with_option(option, 1e8)), IsEmpty());
    EXPECT_THAT(detail_of(with_option(option, 1.1e8)), HasSubstr("from 0 to 1e+08 seconds"));
  }
}

TEST(Ranges, OfLengthsEndAtAMillionMetres) {
  EXPECT_THAT(brief_faults_of(with_robot("radius", 1e-4)), IsEmpty());
  EXPECT_THAT(brief_faults_of(with_robot("radius", 1e-5)),
              ElementsAre(Pair("/robots/0/radius", "out_of_range")));
  EXPECT_THAT(brief_faults_of(with_option("inflation", 1e6)), IsEmpty());
  EXPECT_THAT(brief_faults_of(with_option("inflation", 2e6)),
              ElementsAre(Pair("/options/inflation", "out_of_range")));
}

TEST(Ranges, OfTheMapEndAtAMillionMetres) {
  Json request = Json::parse(R"({"map": {"rows": ["....", "...."], "resolution": 250000},
    "robots": [{"id": "a", "radius": 1, "linear_speed": 1, "angular_speed": 1, "start": {"x": 5, "y": 5}}]})");
  EXPECT_THAT(brief_faults_of(request), IsEmpty());
  request["map"]["resolution"] = 250001;
  EXPECT_THAT(brief_faults_of(request), ElementsAre(Pair("/map/resolution", "out_of_range")));
  EXPECT_THAT(detail_of(request), HasSubstr("must be at most 1e+06 m in each direction. Use a smaller"));
  request["map"] = {{"rows", {std::string(1'000'001, '.')}}};  // a metre is the default
  EXPECT_THAT(brief_faults_of(request), ElementsAre(Pair("/map/rows", "out_of_range")));
}

TEST(Ranges, OfTimesOfGivenPlansEndAtAHundredMillionSeconds) {
  Json request = swap_request();
  request["plans"] = Json::parse(R"([{"robot": "a", "cost": 1.1e8, "actions": [
    {"type": "wait", "t_start": -1.1e8, "t_end": 1e9, "from": {"x": 0.5, "y": 1.5, "theta": 0},
     "to": {"x": 0.5, "y": 1.5, "theta": 0}}]}])");
  const Reply reply = validate_endpoint(request.dump(), {});
  EXPECT_EQ(reply.status, 422);
  const Json errors = json_of(reply)["errors"];
  std::vector<std::string> pointers;
  for (const Json& error : errors) pointers.push_back(error["pointer"]);
  EXPECT_THAT(pointers, testing::UnorderedElementsAre("/plans/0/cost", "/plans/0/actions/0/t_start",
                                                      "/plans/0/actions/0/t_end"));
}

}  // namespace TEST_FILE
}  // namespace fleetplan::api
