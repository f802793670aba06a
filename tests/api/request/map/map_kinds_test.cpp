// The kinds of maps that a request may have.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <ostream>
#include <string>

#include "api/endpoints/endpoints.h"
#include "tests/api/support/maps.h"
#include "tests/support/unbounded_work.h"

namespace fleetplan::api {
namespace TEST_FILE {

using testing::ElementsAre;

const Picture kRoom{"#######", "#..?..#", "#..#..#", "#.....#", "#######"};

Json request_with(const Json& map) {
  Json request = Json::parse(R"({
    "robots": [{"id": "a", "radius": 0.2, "linear_speed": 1.0, "angular_speed": 2.0,
                "start": {"x": -1.25, "y": 2.25}, "goal": {"x": 0.75, "y": 3.25}}]})");
  request["map"] = map;
  return request;
}

/// The cells of the map as they are planned with, and where it lies; or its faults.
Picture drawn(const Json& map) {
  const auto parsed = parse_request(request_with(map).dump(), Limits{}, unbounded_work());
  Picture picture;
  if (!parsed) {
    for (const Fault& fault : parsed.failure().faults) picture.push_back(fault.pointer + ": " + fault.detail);
    return picture;
  }
  const core::OccupancyGrid& grid = parsed->problem.grid();
  EXPECT_EQ(grid.resolution(), kCell);
  EXPECT_EQ(parsed->frame.origin, core::Position(kLeft, kBottom));
  for (int row = grid.rows() - 1; row >= 0; --row) {
    picture.emplace_back();
    for (int column = 0; column < grid.columns(); ++column) {
      picture.back() += grid.blocked({column, row}) ? '#' : '.';
    }
  }
  return picture;
}

Picture with_unknown(Picture picture, char as) {
  for (std::string& row : picture) {
    for (char& cell : row) cell = cell == '?' ? as : cell;
  }
  return picture;
}

struct Drawing {
  std::string name;
  Json (*map)(const Picture& picture);
  bool knows_unknown;
};

void PrintTo(const Drawing& drawing, std::ostream* out) { *out << drawing.name; }

class MapKinds : public testing::TestWithParam<Drawing> {};

TEST_P(MapKinds, HaveTheSameCells) {
  const Picture blocked = with_unknown(kRoom, '#');
  const Picture free = with_unknown(kRoom, '.');
  EXPECT_EQ(drawn(GetParam().map(blocked)), blocked);
  EXPECT_EQ(drawn(GetParam().map(free)), free);
  if (!GetParam().knows_unknown) return;
  Json map = GetParam().map(kRoom);
  EXPECT_EQ(drawn(map), blocked);
  map["unknown"] = "blocked";
  EXPECT_EQ(drawn(map), blocked);
  map["unknown"] = "free";
  EXPECT_EQ(drawn(map), free);
}

TEST_P(MapKinds, HaveTheSamePlan) {
  const Picture picture = with_unknown(kRoom, '#');
  const Json rows = json_of(plan_endpoint(request_with(rows_map(picture)).dump(), RequestContext{}));
  const Json other = json_of(plan_endpoint(request_with(GetParam().map(picture)).dump(), RequestContext{}));
  ASSERT_EQ(rows.at("status"), "solved");
  EXPECT_GT(rows.at("plans")[0].at("actions").size(), 2U);
  EXPECT_EQ(other.at("plans"), rows.at("plans"));
}

INSTANTIATE_TEST_SUITE_P(All, MapKinds,
                         testing::Values(Drawing{"Rows", rows_map, false},
                                         Drawing{"OccupancyGrid", occupancy_grid_map, true},
                                         Drawing{"Pgm", pgm_map, true}, Drawing{"Png", png_map, true},
                                         Drawing{"MovingAi", movingai_map, false}),
                         [](const auto& one) { return one.param.name; });

/// Whether cells of these percentages are blocked, in one row.
std::string of_percents(const Json& percents, const char* unknown) {
  Json map = occupancy_grid_map({std::string(percents.size(), '.')});
  map["occupancy_grid"]["data"] = percents;
  map["unknown"] = unknown;
  Json request = request_with(map);
  request["robots"][0]["start"] = {{"x", kLeft + kCell / 2}, {"y", kBottom + kCell / 2}};
  request["robots"][0].erase("goal");
  const auto parsed = parse_request(request.dump(), Limits{}, unbounded_work());
  if (!parsed) return parsed.failure().detail;
  std::string row;
  for (int column = 0; column < static_cast<int>(percents.size()); ++column) {
    row += parsed->problem.grid().blocked({column, 0}) ? '#' : '.';
  }
  return row;
}

TEST(OccupancyGrid, IsBlockedFrom65AndFreeUpTo25Percent) {
  EXPECT_EQ(of_percents({0, 25, 26, 64, 65, 100, -1, 1.0}, "blocked"), "..#####.");
  EXPECT_EQ(of_percents({0, 25, 26, 64, 65, 100, -1, 1.0}, "free"), "....##..");
}

TEST(OccupancyGrid, MayHaveNoOriginAndNoOrientation) {
  Json map = occupancy_grid_map(with_unknown(kRoom, '.'));
  Json& origin = map["occupancy_grid"]["info"]["origin"];
  origin.erase("orientation");
  EXPECT_EQ(drawn(map), with_unknown(kRoom, '.'));
  origin["orientation"] = {{"x", 0.0}, {"y", 0.0}, {"z", 0.0}, {"w", 0.0}};  // of a message never filled
  EXPECT_EQ(drawn(map), with_unknown(kRoom, '.'));
  map["occupancy_grid"]["info"].erase("origin");
  Json request = request_with(map);
  request["robots"][0]["start"] = {{"x", 0.75}, {"y", 0.75}};
  request["robots"][0]["goal"] = {{"x", 1.25}, {"y", 0.75}};
  EXPECT_THAT(brief_faults_of(request), ElementsAre());
}

TEST(ImageMap, TakesTheMembersOfAMapYaml) {
  Json map = pgm_map(kRoom);
  Json& image = map["image"];
  image["image"] = "room.pgm";
  image["mode"] = "trinary";
  image["negate"] = false;
  EXPECT_EQ(drawn(map), with_unknown(kRoom, '#'));
  image["free_thresh"] = 0.25;  // 205 is 19.6 % occupied
  EXPECT_EQ(drawn(map), with_unknown(kRoom, '.'));
  for (const char* member : {"image", "mode", "negate", "occupied_thresh", "free_thresh"})
    image.erase(member);
  EXPECT_EQ(drawn(map), with_unknown(kRoom, '#'));
}

TEST(ImageMap, HasTheOccupancyOfItsMode) {
  // 0 is 0 % in raw mode, 60 is 60 %, 90 is 90 % and 200 is unknown; negate is of no effect then
  Samples grays(5, std::vector<std::uint8_t>(8, 0));
  grays.front() = {0, 0, 0, 0, 0, 60, 90, 200};
  const Json room = image_map("pgm", pgm(grays));
  Json raw = room;
  raw["image"]["mode"] = "raw";
  EXPECT_EQ(drawn(raw).front(), ".....###");
  raw["unknown"] = "free";
  EXPECT_EQ(drawn(raw).front(), "......#.");
  // With negate, 60 is 23.5 % occupied, 90 35.3 % and 200 78.4 %: of 10 to 90 % in scale mode, 17, 32 and 86
  // %
  Json scale = room;
  scale["image"].update({{"mode", "scale"}, {"negate", 1}, {"occupied_thresh", 0.9}, {"free_thresh", 0.1}});
  EXPECT_EQ(drawn(scale).front(), "......##");
  scale["unknown"] = "free";
  EXPECT_EQ(drawn(scale).front(), ".......#");
}

TEST(MovingAiMap, MayHaveSwampAndAnyLineEnds) {
  Json map = movingai_map(with_unknown(kRoom, '.'));
  const std::string rows = "@OTW#@@\r\nT.S..G@\r\n#..#..#\r\n#.....#\r\n#######\r\n\r\n";
  map["movingai"] = "type octile\r\nwidth 7\r\nheight 5\r\nmap\r\n" + rows;
  EXPECT_EQ(drawn(map), with_unknown(kRoom, '.'));
}

}  // namespace TEST_FILE
}  // namespace fleetplan::api
