// Invalid maps, with one fault each.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/api/support/fault_case.h"
#include "tests/api/support/maps.h"
#include "tests/support/base64.h"

namespace fleetplan::api {
namespace TEST_FILE {

using testing::HasSubstr;

using Case = FaultCase;

const Picture kHall(8, std::string(12, '.'));

Json request_with(const Json& map) {
  Json request = Json::parse(R"({
    "robots": [{"id": "a", "radius": 0.2, "linear_speed": 1.0, "angular_speed": 2.0, "start": {"x": 0.0, "y": 3.0}}]})");
  request["map"] = map;
  return request;
}

Json& message(Json& request) { return request["map"]["occupancy_grid"]; }
Json& grid_info(Json& request) { return message(request)["info"]; }
Json& image(Json& request) { return request["map"]["image"]; }
Json& text(Json& request) { return request["map"]["movingai"]; }

TEST(Map, OfTwoKindsIsAFaultOfTheLaterKind) {
  Json request = request_with(rows_map(kHall));
  request["map"]["image"] = pgm_map(kHall)["image"];
  EXPECT_EQ(brief_faults_of(request), (Faults{{"/map/image", "duplicate"}}));
  EXPECT_THAT(detail_of(request), HasSubstr("given as rows and as image; give one of them"));
}

TEST(Map, MembersOfAnotherKindAreUnknown) {
  Json request = request_with(pgm_map(kHall));
  request["map"]["resolution"] = 0.5;
  EXPECT_EQ(brief_faults_of(request), (Faults{{"/map/resolution", "unknown_key"}}));
  request = request_with(rows_map(kHall));
  request["map"]["unknown"] = "free";
  EXPECT_EQ(brief_faults_of(request), (Faults{{"/map/unknown", "unknown_key"}}));
}

TEST(Map, WithTooManyCellsIsAFaultOfEveryKind) {
  Limits limits;
  limits.max_cells = 95;
  const auto places = [&](const Json& map) { return brief_faults_of(request_with(map), limits); };
  EXPECT_EQ(places(rows_map(kHall)), (Faults{{"/map/rows", "out_of_range"}}));
  EXPECT_EQ(places(occupancy_grid_map(kHall)), (Faults{{"/map/occupancy_grid/info/width", "out_of_range"}}));
  EXPECT_EQ(places(pgm_map(kHall)), (Faults{{"/map/image/pgm", "out_of_range"}}));
  EXPECT_EQ(places(png_map(kHall)), (Faults{{"/map/image/png", "out_of_range"}}));
  EXPECT_EQ(places(movingai_map(kHall)), (Faults{{"/map/movingai", "out_of_range"}}));
  EXPECT_THAT(detail_of(request_with(png_map(kHall)), limits),
              HasSubstr("12 x 8 = 96 pixels; this service accepts at most 95"));
}

TEST(Map, LargerThanTheRangeOfCoordinatesIsAFaultOfEveryKind) {
  const auto scaled = [&](Json map, const char* pointer) {
    Json request = request_with(map);
    request[Json::json_pointer(pointer)] = 1e5;
    return brief_faults_of(request);
  };
  EXPECT_EQ(scaled(movingai_map(kHall), "/map/resolution"), (Faults{{"/map/resolution", "out_of_range"}}));
  EXPECT_EQ(scaled(pgm_map(kHall), "/map/image/resolution"),
            (Faults{{"/map/image/resolution", "out_of_range"}}));
  EXPECT_EQ(scaled(occupancy_grid_map(kHall), "/map/occupancy_grid/info/resolution"),
            (Faults{{"/map/occupancy_grid/info/resolution", "out_of_range"}}));
}

class OneFaultOfAMessage : public testing::TestWithParam<Case> {};
class OneFaultOfAnImage : public testing::TestWithParam<Case> {};
class OneFaultOfMovingAi : public testing::TestWithParam<Case> {};

TEST_P(OneFaultOfAMessage, IsReportedAtItsPlace) {
  expect_one_fault(request_with(occupancy_grid_map(kHall)), GetParam());
}
TEST_P(OneFaultOfAnImage, IsReportedAtItsPlace) {
  expect_one_fault(request_with(pgm_map(kHall)), GetParam());
}
TEST_P(OneFaultOfMovingAi, IsReportedAtItsPlace) {
  expect_one_fault(request_with(movingai_map(kHall)), GetParam());
}

constexpr const char* kMessage = "/map/occupancy_grid";

std::string in_message(const char* member) { return kMessage + std::string(member); }

Json turned(double z, double w) { return {{"x", 0.0}, {"y", 0.0}, {"z", z}, {"w", w}}; }

INSTANTIATE_TEST_SUITE_P(
    All, OneFaultOfAMessage,
    testing::Values(
        Case{"IsAList", [](Json& r) { message(r) = Json::array(); }, kMessage, "wrong_type",
             "must be an object"},
        Case{"NoInfo", [](Json& r) { message(r).erase("info"); }, in_message("/info"), "missing",
             "info is missing"},
        Case{"NoData", [](Json& r) { message(r).erase("data"); }, in_message("/data"), "missing",
             "data is missing"},
        Case{"NoResolution", [](Json& r) { grid_info(r).erase("resolution"); },
             in_message("/info/resolution"), "missing", "resolution is missing"},
        Case{"NoWidth", [](Json& r) { grid_info(r).erase("width"); }, in_message("/info/width"), "missing",
             "width"},
        Case{"WidthIsZero", [](Json& r) { grid_info(r)["width"] = 0; }, in_message("/info/width"),
             "out_of_range", "at least 1, not 0"},
        Case{"HeightIsAFraction", [](Json& r) { grid_info(r)["height"] = 7.5; }, in_message("/info/height"),
             "wrong_type", "a whole number"},
        Case{"UnknownMember", [](Json& r) { grid_info(r)["size"] = 5; }, in_message("/info/size"),
             "unknown_key", "known members"},
        Case{"TooFewData", [](Json& r) { message(r)["data"].erase(0); }, in_message("/data"), "wrong_size",
             "has 95 items, but info.width x info.height are 12 x 8 = 96"},
        Case{"DataAbove100", [](Json& r) { message(r)["data"][17] = 101; }, in_message("/data/17"),
             "out_of_range", "a whole number from -1 to 100, not 101"},
        Case{"DataBelowMinus1", [](Json& r) { message(r)["data"][17] = -2; }, in_message("/data/17"),
             "out_of_range", "-1 to 100"},
        Case{"DataIsAFraction", [](Json& r) { message(r)["data"][17] = 0.5; }, in_message("/data/17"),
             "out_of_range", "a whole number"},
        Case{"DataIsText", [](Json& r) { message(r)["data"] = "AAAA"; }, in_message("/data"), "wrong_type",
             "an array"},
        Case{"DataHasText", [](Json& r) { message(r)["data"][17] = "5"; }, in_message("/data/17"),
             "wrong_type", "a whole number from -1 to 100"},
        Case{"NoX", [](Json& r) { grid_info(r)["origin"]["position"].erase("x"); },
             in_message("/info/origin/position/x"), "missing", "x is missing"},
        Case{"Turned", [](Json& r) { grid_info(r)["origin"]["orientation"] = turned(0.6, 0.8); },
             in_message("/info/origin/orientation"), "out_of_range",
             "is turned by its orientation, by 1.287"},
        Case{"TurnedSlightly", [](Json& r) { grid_info(r)["origin"]["orientation"] = turned(1e-3, 1.0); },
             in_message("/info/origin/orientation"), "out_of_range", "poses in the frame of the image"},
        Case{"Tilted",
             [](Json& r) {
               grid_info(r)["origin"]["orientation"] = {{"x", 0.1}, {"y", 0.0}, {"z", 0.0}, {"w", 0.995}};
             },
             in_message("/info/origin/orientation"), "out_of_range", "is tilted by its orientation"}),
    [](const auto& one) { return one.param.name; });

void replace_file(Json& request, const std::string& file) { image(request)["pgm"] = support::base64(file); }

INSTANTIATE_TEST_SUITE_P(
    All, OneFaultOfAnImage,
    testing::Values(Case{"IsText", [](Json& r) { image(r) = "map.pgm"; }, "/map/image", "wrong_type",
                         "must be an object"},
                    Case{"NoFile", [](Json& r) { image(r).erase("pgm"); }, "/map/image/pgm", "missing",
                         "in base64, as pgm or png"},
                    Case{"TwoFiles", [](Json& r) { image(r)["png"] = image(r)["pgm"]; }, "/map/image/png",
                         "duplicate", "as pgm and as png"},
                    Case{"FileIsAList",
                         [](Json& r) {
                           image(r)["pgm"] = {1, 2};
                         },
                         "/map/image/pgm", "wrong_type", "in base64"},
                    Case{"NotBase64", [](Json& r) { image(r)["pgm"] = "P5.."; }, "/map/image/pgm",
                         "bad_image", "has \".\" at character 3, which is not of base64"},
                    Case{"IsAPng", [](Json& r) { replace_file(r, png(1, {{0}})); }, "/map/image/pgm",
                         "bad_image", "does not begin as a PGM"},
                    Case{"Truncated", [](Json& r) { replace_file(r, pgm(grays_of(kHall)).substr(0, 100)); },
                         "/map/image/pgm", "bad_image", "it is truncated"},
                    Case{"NoResolution", [](Json& r) { image(r).erase("resolution"); },
                         "/map/image/resolution", "missing", "the size of a pixel"},
                    Case{"OriginIsAPoint",
                         [](Json& r) {
                           image(r)["origin"] = {{"x", 0}, {"y", 0}};
                         },
                         "/map/image/origin", "wrong_type", "an array"},
                    Case{"OriginWithoutYaw",
                         [](Json& r) {
                           image(r)["origin"] = {0, 0};
                         },
                         "/map/image/origin", "wrong_size", "it has 2 items"},
                    Case{"Turned", [](Json& r) { image(r)["origin"][2] = 0.1; }, "/map/image/origin/2",
                         "out_of_range",
                         "must be a multiple of pi / 2 (0, 1.5708, 3.1416 or -1.5708), not 0.1"},
                    Case{"TurnedByAlmostAQuarter", [](Json& r) { image(r)["origin"][2] = 1.57; },
                         "/map/image/origin/2", "out_of_range", "not 1.57; turn the image by the rest"},
                    Case{"UnknownRelease", [](Json& r) { image(r)["release"] = "iron"; },
                         "/map/image/release", "unknown_value", "\"jazzy\" or \"humble\""},
                    Case{"UnknownMode", [](Json& r) { image(r)["mode"] = "binary"; }, "/map/image/mode",
                         "unknown_value", "\"trinary\", \"scale\" or \"raw\""},
                    Case{"NegateIsTwo", [](Json& r) { image(r)["negate"] = 2; }, "/map/image/negate",
                         "wrong_type", "true or false"},
                    Case{"ThresholdAboveOne", [](Json& r) { image(r)["occupied_thresh"] = 65; },
                         "/map/image/occupied_thresh", "out_of_range", "from 0 to 1"},
                    Case{"ThresholdsOutOfOrder", [](Json& r) { image(r)["free_thresh"] = 0.7; },
                         "/map/image/free_thresh", "out_of_range", "at most occupied_thresh (0.65), not 0.7"},
                    Case{"ThresholdBelowTheDefaultOfTheOther",
                         [](Json& r) {
                           image(r).erase("free_thresh");
                           image(r)["occupied_thresh"] = 0.1;
                         },
                         "/map/image/occupied_thresh", "out_of_range",
                         "at least free_thresh (0.196, by default), not 0.1"},
                    Case{"UnknownIsAFlag", [](Json& r) { r["map"]["unknown"] = true; }, "/map/unknown",
                         "wrong_type", "\"blocked\" or \"free\""}),
    [](const auto& one) { return one.param.name; });

void replace_in_text(Json& request, const std::string& old, const std::string& by) {
  std::string changed = text(request);
  changed.replace(changed.find(old), old.size(), by);
  text(request) = changed;
}

INSTANTIATE_TEST_SUITE_P(
    All, OneFaultOfMovingAi,
    testing::Values(
        Case{"IsAList", [](Json& r) { text(r) = Json::array(); }, "/map/movingai", "wrong_type",
             "text of a .map file"},
        Case{"IsEmpty", [](Json& r) { text(r) = ""; }, "/map/movingai", "bad_movingai", "Line 1 is \"\""},
        Case{"NoHeader", [](Json& r) { text(r) = "....\n....\n"; }, "/map/movingai", "bad_movingai",
             "Line 1 is \"....\", where the header"},
        Case{"NoMapLine", [](Json& r) { text(r) = "type octile\nheight 3"; }, "/map/movingai", "bad_movingai",
             "no line \"map\""},
        Case{"NoHeight", [](Json& r) { replace_in_text(r, "height 8\n", ""); }, "/map/movingai",
             "bad_movingai", "names no height"},
        Case{"BadWidth", [](Json& r) { replace_in_text(r, "width 12", "width 012"); }, "/map/movingai",
             "bad_movingai", "Line 3 is \"width 012\""},
        Case{"TooFewRows", [](Json& r) { replace_in_text(r, "height 8", "height 9"); }, "/map/movingai",
             "bad_movingai", "has height 9, but 8 rows follow"},
        Case{"TooManyRows", [](Json& r) { replace_in_text(r, "height 8", "height 7"); }, "/map/movingai",
             "bad_movingai", "has height 7, but 8 rows follow"},
        Case{"ShortRow", [](Json& r) { replace_in_text(r, "\n............\n", "\n...........\n"); },
             "/map/movingai", "bad_movingai", "Line 5 has 11 cells, but the header has width 12"},
        Case{"UnknownCell", [](Json& r) { replace_in_text(r, "\n............\n", "\n..é.........\n"); },
             "/map/movingai", "bad_movingai", "Line 5 has \"é\" in column 3"}),
    [](const auto& one) { return one.param.name; });

}  // namespace TEST_FILE
}  // namespace fleetplan::api
