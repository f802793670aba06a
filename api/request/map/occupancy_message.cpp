#include "api/request/map/occupancy_message.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <utility>

#include "api/request/map/map_frame.h"
#include "api/request/ranges.h"

namespace fleetplan::api {

namespace {

constexpr std::array<std::string_view, 3> kMessageMembers{"header", "info", "data"};
constexpr std::array<std::string_view, 5> kInfoMembers{"map_load_time", "resolution", "width", "height",
                                                       "origin"};
constexpr std::array<std::string_view, 2> kPoseMembers{"position", "orientation"};
constexpr std::array<std::string_view, 3> kPositionMembers{"x", "y", "z"};
constexpr std::array<std::string_view, 4> kQuaternionMembers{"x", "y", "z", "w"};
constexpr Range kUnit{-2.0, 2.0, "of a quaternion of length 1"};
constexpr double kTurnTolerance = 1e-6;  // radians, of quaternions computed from angles in single precision
constexpr std::uint64_t kLongestSide = std::numeric_limits<std::int32_t>::max();
constexpr std::uint64_t kFull = 100;      // percent
constexpr std::size_t kWorkOfAnItem = 8;  // what reading one costs, in bytes of text

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

/// The number of columns or rows.
std::optional<std::uint64_t> parse_side(const JsonReader& member) {
  const auto side = member.natural(kLongestSide);
  if (side != std::uint64_t{0}) return side;
  member.must_be(fault::kOutOfRange, "at least 1");
  return std::nullopt;
}

/// The percentage of a valid item.
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

/// The percentages, of which there are as many as cells, unless the stop is met.
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
    if (data.stop().met_after(kWorkOfAnItem)) return std::nullopt;
  }
  return percents;
}

std::string size_detail(std::size_t given, std::uint64_t columns, std::uint64_t rows) {
  return "data has " + std::to_string(given) + " items, but info.width x info.height are " +
         std::to_string(columns) + " x " + std::to_string(rows) + " = " + std::to_string(columns * rows) +
         " cells.";
}

}  // namespace

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

}  // namespace fleetplan::api
