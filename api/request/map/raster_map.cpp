#include "api/request/map/raster_map.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>

#include "api/request/map/image/decode_image.h"
#include "api/request/map/occupancy_message.h"
#include "api/request/ranges.h"

namespace fleetplan::api {

namespace {

constexpr std::int8_t kLeastBlocked = 65;  // percent
constexpr std::int8_t kMostFree = 25;
constexpr std::array<std::string_view, 2> kUnknown{"blocked", "free"};
constexpr std::array<std::string_view, 9> kMapImageMembers{
    "pgm", "png", "resolution", "origin", "negate", "occupied_thresh", "free_thresh", "mode", "image"};
constexpr std::size_t kOriginLength = 3;

/// Whether unknown cells are free.
bool parse_unknown(const JsonReader& member) { return member.word(kUnknown).value_or(0) == 1; }

core::OccupancyGrid draw(const Raster& raster, double resolution, bool unknown_is_free, core::Work& stop) {
  const auto blocked = [&](std::int8_t percent) {
    return percent >= kLeastBlocked || (!unknown_is_free && (percent > kMostFree || percent < 0));
  };
  core::OccupancyGrid grid(raster.columns, raster.rows, resolution);
  for (int row = 0; row < raster.rows && !stop.met_after(static_cast<std::size_t>(raster.columns)); ++row) {
    for (int column = 0; column < raster.columns; ++column) {
      if (blocked(raster.at(column, row))) grid.block({column, row});
    }
  }
  return grid;
}

/// map_server's list of x, y and yaw.
WorldFrame parse_image_origin(const JsonReader& member) {
  const JsonReader origin = member.array();
  if (!origin) return {};
  if (origin.size() != kOriginLength) {
    origin.must_be(fault::kWrongSize, "the list of x, y and yaw as in map.yaml",
                   "; it has " + std::to_string(origin.size()) + " items");
    return {};
  }
  const double x = origin.item(0).number(kCoordinate).value_or(0.0);
  const double y = origin.item(1).number(kCoordinate).value_or(0.0);
  const auto yaw = origin.item(2).number(kAnyAngle);
  if (yaw && *yaw != 0.0)
    origin.item(2).must_be(fault::kOutOfRange, "0, because maps are not turned", kTurnRemedy);
  return {{x, y}};
}

}  // namespace

std::optional<WorldMap> parse_occupancy_grid_map(const JsonReader& map, std::int64_t max_cells) {
  const std::size_t before = map.fault_count();
  const bool unknown_is_free = parse_unknown(map.find("unknown"));
  const auto message = parse_occupancy_message(map.find("occupancy_grid"), max_cells);
  if (!message || map.fault_count() != before) return std::nullopt;
  return WorldMap{draw(message->raster, message->resolution, unknown_is_free, map.stop()), message->frame};
}

std::optional<WorldMap> parse_image_map(const JsonReader& map, std::int64_t max_cells) {
  const std::size_t before = map.fault_count();
  const bool unknown_is_free = parse_unknown(map.find("unknown"));
  const JsonReader image = map.find("image").object(kMapImageMembers);
  if (!image) return std::nullopt;
  const JsonReader resolution = image.require("resolution", "; give the size of a pixel in metres");
  const auto pixel = resolution.number(kLength);
  const WorldFrame frame = parse_image_origin(image.find("origin"));
  const auto raster = decode_image(image, max_cells);
  if (raster && pixel) check_extent(resolution, raster->columns, raster->rows, *pixel);
  if (!raster || map.fault_count() != before) return std::nullopt;
  return WorldMap{draw(*raster, *pixel, unknown_is_free, map.stop()), frame};
}

}  // namespace fleetplan::api
