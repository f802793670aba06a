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

/// Ends the fault of a map that is turned.
constexpr std::string_view kTurnRemedy =
    "; turn the image, or give 0 and all poses in the frame of the image";

/// What a message of the type nav_msgs/OccupancyGrid says.
struct OccupancyMessage {
  Raster raster;
  double resolution = 0.0;  // metres
  WorldFrame frame;
};

constexpr std::array<std::string_view, 3> kMessageMembers{"header", "info", "data"};
constexpr std::array<std::string_view, 5> kInfoMembers{"map_load_time", "resolution", "width", "height",
                                                       "origin"};
constexpr std::array<std::string_view, 2> kPoseMembers{"position", "orientation"};
constexpr std::array<std::string_view, 3> kPositionMembers{"x", "y", "z"};
constexpr std::array<std::string_view, 4> kQuaternionMembers{"x", "y", "z", "w"};
constexpr Range kUnit{-2.0, 2.0, "of a quaternion of length 1"};
constexpr double kTurnTolerance = 1e-6;  // radians, of quaternions computed from angles in single precision
constexpr std::uint64_t kLongestMessageSide = std::numeric_limits<std::int32_t>::max();
constexpr std::uint64_t kFull = 100;      // percent
constexpr std::size_t kWorkOfAnItem = 8;  // work of reading an item, in bytes of text

/// Reports a rotation. All components 0, as in a message that was never filled, is none.
void check_orientation(const JsonReader& member) {
  const std::size_t before = member.fault_count();
  const JsonReader quaternion = member.object(kQuaternionMembers);
  const auto component = [&](const char* name) { return quaternion.find(name).number(kUnit).value_or(0.0); };
  const double turned =
      std::max({std::abs(component("x")), std::abs(component("y")), std::abs(component("z"))});
  const double w = quaternion.find("w") ? component("w") : 1.0;
  if (!quaternion || member.fault_count() != before || turned <= kTurnTolerance / 2.0 * std::abs(w)) return;
  quaternion.fault(fault::kOutOfRange,
                   "The map is turned by its orientation; maps must not be" + std::string(kTurnRemedy) + ".");
}

WorldFrame parse_message_origin(const JsonReader& member) {
  const JsonReader pose = member.object(kPoseMembers);
  const JsonReader position = pose.find("position").object(kPositionMembers);
  const double x = position.require("x").number(kCoordinate).value_or(0.0);
  const double y = position.require("y").number(kCoordinate).value_or(0.0);
  check_orientation(pose.find("orientation"));
  return {{x, y}};
}

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
  const WorldFrame frame = parse_message_origin(info.find("origin"));
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
      {static_cast<int>(*columns), static_cast<int>(*rows), std::move(*percents)}, *resolution, frame};
}

constexpr std::int8_t kLeastBlocked = 65;  // percent
constexpr std::int8_t kMostFree = 25;
constexpr std::array<std::string_view, 2> kUnknown{"blocked", "free"};
constexpr std::array<std::string_view, 9> kMapImageMembers{
    "pgm", "png", "resolution", "origin", "negate", "occupied_thresh", "free_thresh", "mode", "image"};
constexpr std::size_t kOriginLength = 3;

/// Reads whether unknown cells are free.
bool parse_unknown(const JsonReader& member) { return member.word(kUnknown).value_or(0) == 1; }

core::OccupancyGrid draw(const Raster& raster, double resolution, bool unknown_is_free, core::Work& work) {
  const auto blocked = [&](std::int8_t percent) {
    return percent >= kLeastBlocked || (!unknown_is_free && (percent > kMostFree || percent < 0));
  };
  core::OccupancyGrid grid(raster.columns, raster.rows, resolution);
  for (int row = 0; row < raster.rows && !work.met_after(static_cast<std::size_t>(raster.columns)); ++row) {
    for (int column = 0; column < raster.columns; ++column) {
      if (blocked(raster.at(column, row))) grid.block({column, row});
    }
  }
  return grid;
}

/// Reads the origin from map_server's list of x, y and yaw.
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
  return WorldMap{draw(message->raster, message->resolution, unknown_is_free, map.work()), message->frame};
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
  return WorldMap{draw(*raster, *pixel, unknown_is_free, map.work()), frame};
}

}  // namespace fleetplan::api
