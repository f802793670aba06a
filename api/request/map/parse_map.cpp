#include "api/request/map/parse_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "api/json/errors.h"
#include "api/json/json_reader.h"
#include "api/request/limits.h"
#include "api/request/map/image/decode_image.h"
#include "api/request/map/raster_place.h"

namespace fleetplan::api {

namespace {

constexpr std::array<std::string_view, 2> kOriginMembers{"x", "y"};

}  // namespace

MapFrame parse_map_frame(const JsonReader& map) {
  const double resolution = map.find("resolution").number(kLength).value_or(1.0);
  const JsonReader origin = map.find("origin").object(kOriginMembers);
  const double x = origin.require("x").number(kCoordinate).value_or(0.0);
  const double y = origin.require("y").number(kCoordinate).value_or(0.0);
  return {resolution, {{x, y}}};
}

bool check_cells(const JsonReader& place, std::uint64_t columns, std::uint64_t rows, std::int64_t max_cells) {
  const std::uint64_t cells = columns * rows;
  if (cells <= static_cast<std::uint64_t>(max_cells)) return true;
  place.fault(fault::kOutOfRange, "The map has " + std::to_string(columns) + " x " + std::to_string(rows) +
                                      " = " + std::to_string(cells) +
                                      " cells; this service accepts at most " + std::to_string(max_cells) +
                                      ". Use a coarser resolution or a part of the map.");
  return false;
}

bool check_extent(const JsonReader& place, double columns, double rows, double resolution) {
  const double width = columns * resolution;
  const double height = rows * resolution;
  if (width <= kLargestExtent && height <= kLargestExtent) return true;
  place.fault(fault::kOutOfRange, "The map is " + number_text(width) + " m x " + number_text(height) +
                                      " m; it must be at most " + number_text(kLargestExtent) +
                                      " m in each direction. Use a smaller resolution or a part of the map.");
  return false;
}

namespace {

using Parse = std::optional<WorldMap> (*)(const JsonReader& map, std::int64_t max_cells);

struct Kind {
  std::string_view name;  // member that makes a map one of this kind
  std::array<std::string_view, 3> members;
  Parse parse;
};

constexpr std::array<Kind, 4> kMapKinds{{
    {"rows", {"rows", "resolution", "origin"}, parse_rows_map},
    {"occupancy_grid", {"occupancy_grid", "unknown", "unknown"}, parse_occupancy_grid_map},
    {"image", {"image", "unknown", "unknown"}, parse_image_map},
    {"movingai", {"movingai", "resolution", "origin"}, parse_movingai_map},
}};

}  // namespace

std::optional<WorldMap> parse_map(const JsonReader& member, std::int64_t max_cells) {
  const std::size_t before = member.fault_count();
  const Kind* found = nullptr;
  for (const Kind& kind : kMapKinds) {
    const JsonReader given = member.find(kind.name);
    if (!given) continue;
    if (found != nullptr) {
      given.fault(fault::kDuplicate, "The map is given as " + std::string(found->name) + " and as " +
                                         std::string(kind.name) + "; give one of them.");
      return std::nullopt;
    }
    found = &kind;
  }
  const JsonReader map = member.object((found != nullptr ? *found : kMapKinds.front()).members);
  if (found == nullptr) {
    map.require("rows",
                "; give one string for each row, the top one first, or an occupancy_grid, an image or a "
                "movingai map instead");
    return std::nullopt;
  }
  auto made = found->parse(map, max_cells);
  if (member.fault_count() != before) return std::nullopt;
  return made;
}

namespace {

/// What a message of the type nav_msgs/OccupancyGrid says.
struct OccupancyMessage {
  Raster raster;
  double resolution = 0.0;  // metres
  RasterPose pose;
};

constexpr std::array<std::string_view, 3> kMessageMembers{"header", "info", "data"};
constexpr std::array<std::string_view, 5> kInfoMembers{"map_load_time", "resolution", "width", "height",
                                                       "origin"};
constexpr std::uint64_t kLongestMessageSide = std::numeric_limits<std::int32_t>::max();
constexpr std::uint64_t kFull = 100;      // percent
constexpr std::size_t kWorkOfAnItem = 8;  // work of reading an item, in bytes of text

/// Reads the number of columns or rows.
std::optional<std::uint64_t> parse_side(const JsonReader& member) {
  const auto side = member.natural(kLongestMessageSide);
  if (side != std::uint64_t{0}) return side;
  member.must_be(fault::kOutOfRange, "at least 1");
  return std::nullopt;
}

/// Returns the percentage of a valid item.
std::optional<std::int8_t> percent_of(const JsonValue& item) {
  if (const auto natural = item.natural(); natural && *natural <= kFull) {
    return static_cast<std::int8_t>(*natural);
  }
  return item.number() == -1.0 ? std::optional(kUnknownOccupancy) : std::nullopt;
}

void report_items(const JsonReader& data) {
  for (const JsonReader item : data.items()) {
    if (percent_of(item.value())) continue;
    item.must_be(item.is_number() ? fault::kOutOfRange : fault::kWrongType, "a whole number from -1 to 100");
  }
}

/// Reads the percentages, of which there are as many as cells, unless `work` is met.
std::optional<std::vector<std::int8_t>> parse_data(const JsonReader& data) {
  std::vector<std::int8_t> percents;
  percents.reserve(data.size());
  for (const JsonValue item : data.value().children()) {
    const auto percent = percent_of(item);
    if (!percent) {
      report_items(data);
      return std::nullopt;
    }
    percents.push_back(*percent);
    if (data.work().met_after(kWorkOfAnItem)) return std::nullopt;
  }
  return percents;
}

std::string size_detail(std::size_t given, std::uint64_t columns, std::uint64_t rows) {
  return "data has " + std::to_string(given) + " items, but info.width x info.height are " +
         std::to_string(columns) + " x " + std::to_string(rows) + " = " + std::to_string(columns * rows) +
         " cells.";
}

/// Reads a message from JSON as rosbridge and `ros2 topic echo` write it; times and the header are ignored.
/// Returns none when it has a fault or when the reading of the document is stopped.
std::optional<OccupancyMessage> parse_occupancy_message(const JsonReader& message, std::int64_t max_cells) {
  const std::size_t before = message.fault_count();
  const JsonReader read = message.object(kMessageMembers);
  const JsonReader info = read.require("info").object(kInfoMembers);
  const JsonReader length = info.require("resolution");
  const auto resolution = length.number(kLength);
  const auto columns = parse_side(info.require("width"));
  const auto rows = parse_side(info.require("height"));
  const RasterPose pose = parse_message_origin(info.find("origin"));
  const JsonReader data = read.require("data").array();
  if (!data || !columns || !rows || !check_cells(info.find("width"), *columns, *rows, max_cells))
    return std::nullopt;
  if (data.size() != *columns * *rows) {
    data.fault(fault::kWrongSize, size_detail(data.size(), *columns, *rows));
    return std::nullopt;
  }
  if (resolution) {
    check_extent(length, static_cast<double>(*columns), static_cast<double>(*rows), *resolution);
  }
  auto percents = parse_data(data);
  if (!percents || message.fault_count() != before) return std::nullopt;
  return OccupancyMessage{
      {static_cast<int>(*columns), static_cast<int>(*rows), std::move(*percents)}, *resolution, pose};
}

constexpr std::int8_t kLeastBlocked = 65;  // percent
constexpr std::int8_t kMaxFree = 25;
constexpr std::array<std::string_view, 2> kUnknown{"blocked", "free"};
constexpr std::array<std::string_view, 10> kMapImageMembers{
    "pgm",         "png",  "resolution", "origin", "negate", "occupied_thresh",
    "free_thresh", "mode", "image",      "release"};

/// Reads whether unknown cells are free.
bool parse_unknown(const JsonReader& member) { return member.word(kUnknown).value_or(0) == 1; }

bool is_blocked(std::int8_t percent, bool unknown_is_free) {
  return percent >= kLeastBlocked || (!unknown_is_free && (percent > kMaxFree || percent < 0));
}

Meanings meanings_of_cells(bool unknown_is_free) {
  Meanings meanings{};
  for (std::size_t index = 0; index < meanings.size(); ++index) {
    const auto percent = static_cast<std::int8_t>(static_cast<int>(index) + kUnknownOccupancy);
    meanings[index] = is_blocked(percent, unknown_is_free) ? 1 : 0;
  }
  return meanings;
}

/// Returns the map of a raster, turned as its pose says. Ends early when `work` is met.
WorldMap map_of(const Raster& raster, double resolution, const RasterPose& pose, bool unknown_is_free,
                core::Work& work) {
  const bool is_across = pose.quarter_turns % 2 == 1;
  core::OccupancyGrid grid(is_across ? raster.rows : raster.columns, is_across ? raster.columns : raster.rows,
                           resolution);
  for (int row = 0; row < raster.rows && !work.met_after(static_cast<std::size_t>(raster.columns)); ++row) {
    for (int column = 0; column < raster.columns; ++column) {
      if (!is_blocked(raster.at(column, row), unknown_is_free)) continue;
      grid.block(turned_cell({column, row}, raster.columns, raster.rows, pose.quarter_turns));
    }
  }
  const WorldFrame frame{lower_left_of(pose, raster.columns * resolution, raster.rows * resolution)};
  return WorldMap{std::move(grid), frame, pose, {}};
}

/// Returns warnings about pixels that may not mean what they are read as.
std::vector<std::string> image_warnings(const DecodedImage& image, bool unknown_is_free) {
  std::vector<std::string> warnings;
  if (image.changed > 0) warnings.push_back(changed_pixels_warning("map.image", image.changed));
  if (image.free_unknown > 0 && !unknown_is_free) {
    warnings.push_back(
        "free_thresh (" + number_text(image.rule.free_thresh) + ") of map.image makes the gray " +
        std::to_string(kUnknownGray) + " free, with which map_saver writes unknown cells; " +
        std::to_string(image.free_unknown) + (image.free_unknown == 1 ? " pixel has it" : " pixels have it") +
        ". Give 0.196 to keep them unknown, or \"unknown\": \"free\" if they may be driven on.");
  }
  return warnings;
}

}  // namespace

std::optional<WorldMap> parse_occupancy_grid_map(const JsonReader& map, std::int64_t max_cells) {
  const std::size_t before = map.fault_count();
  const bool unknown_is_free = parse_unknown(map.find("unknown"));
  const auto message = parse_occupancy_message(map.find("occupancy_grid"), max_cells);
  if (!message || map.fault_count() != before) return std::nullopt;
  return map_of(message->raster, message->resolution, message->pose, unknown_is_free, map.work());
}

std::optional<WorldMap> parse_image_map(const JsonReader& map, std::int64_t max_cells) {
  const std::size_t before = map.fault_count();
  const bool unknown_is_free = parse_unknown(map.find("unknown"));
  const JsonReader image = map.find("image").object(kMapImageMembers);
  if (!image) return std::nullopt;
  const JsonReader resolution = image.require("resolution", "; give the size of a pixel in metres");
  const auto pixel = resolution.number(kLength);
  const RasterPose pose = parse_yaml_origin(image.find("origin")).value_or(RasterPose{});
  const auto read = decode_image(image, max_cells, meanings_of_cells(unknown_is_free));
  if (read && pixel) check_extent(resolution, read->raster.columns, read->raster.rows, *pixel);
  if (!read || map.fault_count() != before) return std::nullopt;
  WorldMap made = map_of(read->raster, *pixel, pose, unknown_is_free, map.work());
  made.warnings = image_warnings(*read, unknown_is_free);
  return made;
}

}  // namespace fleetplan::api
