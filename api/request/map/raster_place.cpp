#include "api/request/map/raster_place.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>
#include <string_view>

#include "api/json/errors.h"
#include "api/request/limits.h"
#include "core/geometry/elementary_functions.h"

namespace fleetplan::api {

core::Position RasterPose::turned(const core::Position& offset) const {
  switch (quarter_turns) {
    case 1:
      return {-offset.y(), offset.x()};
    case 2:
      return {-offset.x(), -offset.y()};
    case 3:
      return {offset.y(), -offset.x()};
    default:
      return offset;
  }
}

core::Cell turned_cell(const core::Cell& cell, int columns, int rows, int quarter_turns) {
  switch (quarter_turns) {
    case 1:
      return {rows - 1 - cell.row, cell.column};
    case 2:
      return {columns - 1 - cell.column, rows - 1 - cell.row};
    case 3:
      return {cell.row, columns - 1 - cell.column};
    default:
      return cell;
  }
}

core::Position lower_left_of(const RasterPose& pose, double width, double height) {
  const core::Position opposite = pose.turned({width, height});
  return pose.corner + core::Position(std::min(opposite.x(), 0.0), std::min(opposite.y(), 0.0));
}

namespace {

/// How far the angle of a map may be from a quarter turn, radians. It is half a centimetre on 50 m: angles
/// have four decimals in files, and come from single precision in messages.
constexpr double kTurnTolerance = 1e-4;

constexpr std::string_view kWantedYaw = "a multiple of pi / 2 (0, 1.5708, 3.1416 or -1.5708)";
constexpr std::string_view kTurnRemedy =
    "; turn the image by the rest, or give 0 and all poses in the frame of the image";

/// Returns the number of quarter turns, 0 to 3; none if the angle is not near to a whole number of them.
std::optional<int> quarter_turns_of(double yaw) {
  constexpr double kQuarter = std::numbers::pi / 2.0;
  const double within = std::remainder(yaw, 4.0 * kQuarter);
  const double turns = std::round(within / kQuarter);  // -2 to 2
  if (std::abs(within - turns * kQuarter) > kTurnTolerance) return std::nullopt;
  return (static_cast<int>(turns) + 4) % 4;
}

constexpr std::size_t kOriginLength = 3;

constexpr std::array<std::string_view, 2> kPoseMembers{"position", "orientation"};
constexpr std::array<std::string_view, 3> kPositionMembers{"x", "y", "z"};
constexpr std::array<std::string_view, 4> kQuaternionMembers{"x", "y", "z", "w"};
constexpr Range kUnit{-2.0, 2.0, "of a quaternion of length 1"};

/// Reads an orientation as quarter turns.
int parse_orientation(const JsonReader& member) {
  const std::size_t before = member.fault_count();
  const JsonReader quaternion = member.object(kQuaternionMembers);
  const auto component = [&](const char* name) { return quaternion.find(name).number(kUnit).value_or(0.0); };
  const double tilt = core::Position(component("x"), component("y")).norm();
  const double z = component("z");
  const double w = quaternion.find("w") ? component("w") : 1.0;
  if (!quaternion || member.fault_count() != before) return 0;
  if (tilt > kTurnTolerance / 2.0 * core::Position(z, w).norm()) {
    quaternion.fault(fault::kOutOfRange,
                     "The map is tilted by its orientation, as x and y are not 0; give a turn about z alone" +
                         std::string(kTurnRemedy) + ".");
    return 0;
  }
  const double yaw = z == 0.0 ? 0.0 : 2.0 * core::arctangent(z, w);
  const auto turns = quarter_turns_of(yaw);
  if (!turns) {
    quaternion.fault(fault::kOutOfRange, "The map is turned by its orientation, by " + number_text(yaw) +
                                             " rad; it must be " + std::string(kWantedYaw) +
                                             std::string(kTurnRemedy) + ".");
  }
  return turns.value_or(0);
}

}  // namespace

std::optional<RasterPose> parse_yaml_origin(const JsonReader& member) {
  const JsonReader origin = member.array();
  if (!origin) return std::nullopt;
  if (origin.size() != kOriginLength) {
    origin.must_be(fault::kWrongSize, "the list of x, y and yaw as in map.yaml",
                   "; it has " + std::to_string(origin.size()) + " items");
    return std::nullopt;
  }
  const double x = origin.item(0).number(kCoordinate).value_or(0.0);
  const double y = origin.item(1).number(kCoordinate).value_or(0.0);
  const auto yaw = origin.item(2).number(kAnyAngle);
  const auto turns = quarter_turns_of(yaw.value_or(0.0));
  if (!turns) origin.item(2).must_be(fault::kOutOfRange, kWantedYaw, kTurnRemedy);
  return RasterPose{{x, y}, turns.value_or(0)};
}

RasterPose parse_message_origin(const JsonReader& member) {
  const JsonReader pose = member.object(kPoseMembers);
  const JsonReader position = pose.find("position").object(kPositionMembers);
  const double x = position.require("x").number(kCoordinate).value_or(0.0);
  const double y = position.require("y").number(kCoordinate).value_or(0.0);
  return {{x, y}, parse_orientation(pose.find("orientation"))};
}

}  // namespace fleetplan::api
