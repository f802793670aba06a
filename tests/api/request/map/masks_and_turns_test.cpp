// Maps and masks in frames of their own: each cell lies where ROS has it, whatever its yaw. Expected places
// are computed here from the pose of the lower-left corner.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "core/model/drive_zones.h"
#include "tests/api/support/maps.h"
#include "tests/support/unbounded_work.h"

namespace fleetplan::api {
namespace TEST_FILE {

using core::Position;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

constexpr double kPi = std::numbers::pi;

/// A pose of a raster as a map.yaml has it.
struct Origin {
  double x;
  double y;
  double yaw;
};

/// The centre of a pixel in the world; rows from the top.
Position centre(const Origin& origin, const Samples& grays, double size, std::size_t row,
                std::size_t column) {
  const double x = (static_cast<double>(column) + 0.5) * size;
  const double y = (static_cast<double>(grays.size() - row) - 0.5) * size;
  return {origin.x + std::cos(origin.yaw) * x - std::sin(origin.yaw) * y,
          origin.y + std::sin(origin.yaw) * x + std::cos(origin.yaw) * y};
}

Json with_robots(Json map) {
  Json request = Json::parse(R"({"robot_defaults": {"radius": 0.01, "linear_speed": 1, "angular_speed": 1},
                                 "options": {"invalid_robots": "report"}, "robots": []})");
  request["map"] = std::move(map);
  return request;
}

void add_robot(Json& request, const Position& at) {
  Json& robots = request["robots"];
  robots.push_back({{"id", std::to_string(robots.size())}, {"start", {{"x", at.x()}, {"y", at.y()}}}});
}

/// By robot: whether it stands in an obstacle; or the detail of a fault.
std::vector<bool> blocked(const Json& request) {
  const auto read = parse_request(request.dump(), Limits{}, unbounded_work());
  std::vector<bool> found;
  if (!read) ADD_FAILURE() << read.failure().detail;
  if (!read) return found;
  for (const core::Robot& robot : read->problem.robots()) found.push_back(robot.invalid);
  return found;
}

/// Grays without symmetry.
const Samples kGrays{{0, 254, 254, 254, 0}, {254, 254, 0, 254, 254}, {254, 254, 254, 254, 0}};

std::vector<bool> expected_of(const Samples& grays) {
  std::vector<bool> expected;
  for (const auto& row : grays) {
    for (const std::uint8_t gray : row) expected.push_back(gray == 0);
  }
  return expected;
}

Json turned_image(const Origin& origin) {
  Json map = image_map("pgm", pgm(kGrays));
  map["image"]["origin"] = {origin.x, origin.y, origin.yaw};
  return map;
}

Json turned_message(const Origin& origin) {
  Json data = Json::array();
  for (auto row = kGrays.rbegin(); row != kGrays.rend(); ++row) {
    for (const std::uint8_t gray : *row) data.push_back(gray == 0 ? 100 : 0);
  }
  return {
      {"occupancy_grid",
       {{"info",
         {{"resolution", kCell},
          {"width", kGrays.front().size()},
          {"height", kGrays.size()},
          {"origin",
           {{"position", {{"x", origin.x}, {"y", origin.y}, {"z", 0.0}}},
            {"orientation",
             {{"x", 0.0}, {"y", 0.0}, {"z", std::sin(origin.yaw / 2)}, {"w", std::cos(origin.yaw / 2)}}}}}}},
        {"data", data}}}};
}

/// Yaws that are a number of quarter turns, as files have them.
const std::vector<double> kYaws{0.0,  1e-9,     -1e-9,  kPi / 2, 1.5708,  kPi,         3.1416,
                                -kPi, -kPi / 2, 4.7124, 6.2832,  2 * kPi, 5 * kPi / 2, -1.5708};

TEST(TurnedMaps, HaveTheirCellsWhereRosHasThem) {
  for (const double yaw : kYaws) {
    const Origin origin{-1.25, 3.5, yaw};
    for (const Json& map : {turned_image(origin), turned_message(origin)}) {
      Json request = with_robots(map);
      for (std::size_t row = 0; row < kGrays.size(); ++row) {
        for (std::size_t column = 0; column < kGrays[row].size(); ++column) {
          add_robot(request, centre(origin, kGrays, kCell, row, column));
        }
      }
      EXPECT_EQ(blocked(request), expected_of(kGrays)) << yaw;
    }
  }
}

/// A mask of another size, resolution and yaw than the map.
TEST(Masks, LieInFramesOfTheirOwn) {
  const Samples mask{{0, 255, 0, 255}, {255, 255, 0, 0}, {255, 0, 255, 255}};
  for (const double yaw : kYaws) {
    for (const double size : {0.1, 0.25, 0.7}) {
      const Origin origin{4.9, 5.2, yaw};
      Json request = with_robots({{"rows", std::vector<std::string>(20, std::string(20, '.'))},
                                  {"resolution", 0.5},
                                  {"origin", {{"x", 0.0}, {"y", 0.0}}}});
      request["zones"] = Json::array({{{"id", "z"},
                                       {"type", "blocked"},
                                       {"mask",
                                        {{"pgm", support::base64(pgm(mask))},
                                         {"resolution", size},
                                         {"origin", {origin.x, origin.y, origin.yaw}}}}}});
      for (std::size_t row = 0; row < mask.size(); ++row) {
        for (std::size_t column = 0; column < mask[row].size(); ++column) {
          add_robot(request, centre(origin, mask, size, row, column));
        }
      }
      EXPECT_EQ(blocked(request), expected_of(mask)) << yaw << ' ' << size;
    }
  }
}

TEST(Masks, WithoutAFrameAreTurnedWithTheMap) {
  Samples open = kGrays;
  for (auto& row : open) {
    for (auto& gray : row) gray = 254;
  }
  for (const double yaw : kYaws) {
    const Origin origin{-1.25, 3.5, yaw};
    Json map = turned_image(origin);
    map["image"]["pgm"] = support::base64(pgm(open));
    Json request = with_robots(map);
    request["zones"] =
        Json::array({{{"id", "z"}, {"type", "blocked"}, {"mask", {{"pgm", support::base64(pgm(kGrays))}}}}});
    for (std::size_t row = 0; row < kGrays.size(); ++row) {
      for (std::size_t column = 0; column < kGrays[row].size(); ++column) {
        add_robot(request, centre(origin, kGrays, kCell, row, column));
      }
    }
    EXPECT_EQ(blocked(request), expected_of(kGrays)) << yaw;
  }
}

TEST(Masks, OffTheMapCountAgainstNoLimit) {
  Limits limits;
  limits.max_zone_corners = 4;
  Json request = swap_request();
  request["zones"] = Json::array({{{"id", "z"},
                                   {"type", "blocked"},
                                   {"mask",
                                    {{"pgm", support::base64(pgm({{0, 255, 0, 255, 0}}))},
                                     {"resolution", 1.0},
                                     {"origin", {4.0, 3.0, 0.0}}}}}});
  EXPECT_THAT(brief_faults_of(request, limits),
              ElementsAre(Faults::value_type("/zones/0/mask", "out_of_range")));
  request["zones"][0]["mask"]["origin"][0] = 8.0;  // the other two are beyond the map
  EXPECT_THAT(brief_faults_of(request, limits), IsEmpty());
}

/// A corridor of a cell with a mask of speeds over it, of one shade in each cell.
Json corridor(const std::vector<std::uint8_t>& grays) {
  Json request = Json::parse(R"({"robots": [{"id": "a", "radius": 0.3, "linear_speed": 2, "angular_speed": 1,
                                             "start": {"x": 0.5, "y": 0.5}}]})");
  request["map"] = {{"rows", {std::string(grays.size(), '.')}}};
  request["zones"] = Json::array({{{"id", "slow"},
                                   {"type", "speed"},
                                   {"mask",
                                    {{"pgm", support::base64(pgm({grays}))},
                                     {"mode", "scale"},
                                     {"occupied_thresh", 1.0},
                                     {"free_thresh", 0.0}}}}});
  return request;
}

/// The shares of the zones, by column; 0 for columns without.
std::vector<double> shares(const Json& request, std::size_t columns,
                           std::vector<std::string>* warnings = {}) {
  const auto read = parse_request(request.dump(), Limits{}, unbounded_work());
  std::vector<double> found(columns, 0.0);
  if (!read) ADD_FAILURE() << read.failure().detail;
  if (!read) return found;
  if (warnings != nullptr) *warnings = read->warnings;
  for (const core::Zone& zone : read->problem.zones()) {
    const auto column = static_cast<std::size_t>(zone.polygon.front().x() + 0.5);
    found[column] = std::round(zone.linear_speed_for(1.0) * 1e6) / 1e6;
  }
  return found;
}

TEST(SpeedMasks, LimitToBasePlusMultiplierTimesPercent) {
  // 100 x (1 - gray / 255): 191 is 25 %, 128 50 %, 64 75 %, 0 100 %
  const std::vector<std::uint8_t> grays{191, 255, 128, 64, 0};
  Json request = corridor(grays);
  std::vector<std::string> warnings;
  EXPECT_THAT(shares(request, 5, &warnings), ElementsAre(0.75, 0, 0.5, 0.25, 0));
  EXPECT_THAT(warnings, ElementsAre(HasSubstr("base 0 and multiplier 1 for the old reading"),
                                    HasSubstr("does not limit the speed where it has 100 percent")));
  Json& mask = request["zones"][0]["mask"];
  mask["base"] = 0;
  mask["multiplier"] = 1;
  EXPECT_THAT(shares(request, 5, &warnings), ElementsAre(0.25, 0, 0.5, 0.75, 1));
  EXPECT_THAT(warnings, IsEmpty());
  mask["base"] = 20;
  mask["multiplier"] = 1.5;  // 20 + 1.5 x 75 is more than 100, which is no limit
  EXPECT_THAT(shares(request, 5, &warnings), ElementsAre(0.575, 0, 0.95, 0, 0));
  EXPECT_THAT(warnings, ElementsAre(HasSubstr("make a limit of 170 percent")));
}

TEST(SpeedMasks, ThatMeanTheSameAsBeforeHaveNoWarning) {
  std::vector<std::string> warnings;
  EXPECT_THAT(shares(corridor({255, 128, 255}), 3, &warnings), ElementsAre(0, 0.5, 0));
  EXPECT_THAT(warnings, IsEmpty());
}

TEST(SpeedMasks, OfManyZonesHaveOneWarningOfAKind) {
  Json request = corridor({191, 255});
  for (int k = 0; k < 9; ++k) {
    request["zones"].push_back(request["zones"][0]);
    request["zones"].back()["id"] = std::to_string(k);
  }
  std::vector<std::string> warnings;
  shares(request, 2, &warnings);
  EXPECT_THAT(warnings, ElementsAre(HasSubstr("(And 9 more like it.)")));
}

std::vector<std::string> warnings_of(const Json& map) {
  Json request = with_robots(map);
  add_robot(request, {kLeft + 0.25, kBottom + 0.25});
  const auto read = parse_request(request.dump(), Limits{}, unbounded_work());
  if (!read) return {"fault: " + read.failure().detail};
  return read->warnings;
}

TEST(ImageWarnings, TellWhatHumbleReadOtherwise) {
  const Samples rgba{{205, 205, 205, 255, 255, 255, 255, 255, 0, 0, 0, 255}};
  Json map = image_map("png", png(3, rgba, {.colour_type = PNG_COLOR_TYPE_RGB_ALPHA}));
  EXPECT_THAT(warnings_of(map), ElementsAre(HasSubstr("Of map.image, 1 pixel means something else")));
  for (const char* release : {"jazzy", "humble"}) {
    map["image"]["release"] = release;
    EXPECT_THAT(warnings_of(map), IsEmpty());
  }
  map["image"].erase("release");
  map["unknown"] = "free";  // both readings have the cell free
  EXPECT_THAT(warnings_of(map), IsEmpty());
  EXPECT_THAT(warnings_of(pgm_map({"..#??"})), IsEmpty());
}

TEST(ImageWarnings, TellOfAThresholdThatMakesUnknownCellsFree) {
  Json map = pgm_map({"..#??"});
  map["image"]["free_thresh"] = 0.25;
  EXPECT_THAT(warnings_of(map), ElementsAre(HasSubstr("makes the gray 205 free")));
  EXPECT_THAT(warnings_of(map).front(), HasSubstr("2 pixels have it. Give 0.196"));
  map["image"]["free_thresh"] = 0.196;  // the remedies
  EXPECT_THAT(warnings_of(map), IsEmpty());
  map["image"]["free_thresh"] = 0.25;
  map["unknown"] = "free";
  EXPECT_THAT(warnings_of(map), IsEmpty());
  Json known = pgm_map({"..#.."});  // no pixel has it
  known["image"]["free_thresh"] = 0.25;
  EXPECT_THAT(warnings_of(known), IsEmpty());
}

}  // namespace TEST_FILE
}  // namespace fleetplan::api
