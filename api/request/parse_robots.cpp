#include "api/request/parse_robots.h"

#include <array>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>

#include "api/json/object_reader.h"
#include "api/json/text.h"
#include "core/geometry/angle.h"

namespace fleetplan::api {

namespace {

constexpr std::array<std::string_view, 6> kMembers{"id",    "radius", "linear_speed", "angular_speed",
                                                   "start", "goal"};
constexpr std::array<std::string_view, 3> kPoseMembers{"x", "y", "theta"};

// What a robot is made of, and may take from the defaults.
constexpr std::array<std::string_view, 3> kTraits{"radius", "linear_speed", "angular_speed"};
constexpr std::array<Range, 3> kTraitRanges{
    {kLength, {kSmallest, kLargest, "metres per second"}, {kSmallest, kLargest, "radians per second"}}};

/// The defaults of all robots: what is given, and what of it is good.
struct Traits {
  std::array<bool, 3> given{};
  std::array<std::optional<double>, 3> values;
};

Traits parse_traits(const ObjectReader& reader, FaultList& faults) {
  Traits traits;
  for (std::size_t trait = 0; trait < kTraits.size(); ++trait) {
    const JsonValue* member = reader.find(kTraits[trait]);
    if (member == nullptr) continue;
    traits.given[trait] = true;
    traits.values[trait] = read_number(*member, reader.path(kTraits[trait]), kTraitRanges[trait], faults);
  }
  return traits;
}

/// A robot's own traits, completed by the defaults. What neither gives is missing; what the defaults give
/// wrongly has been told there.
Traits completed(Traits traits, const Traits& defaults, const ObjectReader& reader) {
  for (std::size_t trait = 0; trait < kTraits.size(); ++trait) {
    if (traits.given[trait]) continue;
    if (defaults.given[trait]) {
      traits.values[trait] = defaults.values[trait];
    } else {
      reader.require(kTraits[trait], ", here and in robot_defaults; give it in one of them");
    }
  }
  return traits;
}

/// A pose with or without a heading, in the map frame.
std::optional<core::Goal> parse_pose(const JsonValue& value, const JsonPath& path, const WorldFrame& frame,
                                     FaultList& faults) {
  const std::size_t before = faults.count();
  const ObjectReader reader(value, path, kPoseMembers, faults);
  const auto x = reader.require_number("x", kCoordinate);
  const auto y = reader.require_number("y", kCoordinate);
  core::Goal pose;
  if (const JsonValue* theta = reader.find("theta")) {
    if (const auto angle = read_number(*theta, reader.path("theta"), kAnyAngle, faults)) {
      pose.theta = core::normalize_angle(*angle);
    }
  }
  if (!x || !y || faults.count() != before) return std::nullopt;
  pose.position = frame.to_map({*x, *y});
  return pose;
}

ReadRobot parse_robot(const JsonValue& value, const JsonPath& path, const Traits& defaults,
                      const WorldFrame& frame, FaultList& faults) {
  ReadRobot read;
  core::Robot& robot = read.robot;
  const ObjectReader reader(value, path, kMembers, faults);
  if (!reader.is_object()) return read;
  if (const JsonValue* id = reader.require("id")) {
    robot.id = read_name(*id, reader.path("id"), faults).value_or("");
  }
  const Traits traits = completed(parse_traits(reader, faults), defaults, reader);
  robot.radius = traits.values[0].value_or(1.0);
  robot.linear_speed = traits.values[1].value_or(1.0);
  robot.angular_speed = traits.values[2].value_or(1.0);
  std::optional<core::Goal> start;
  if (const JsonValue* pose = reader.require("start", "; give {\"x\", \"y\"} and, if you like, \"theta\"")) {
    read.start_at = pose->begins();
    const JsonPath start_path = reader.path("start");
    start = parse_pose(*pose, start_path, frame, faults);
    if (start) robot.start = {start->position, start->theta.value_or(0.0)};
  }
  if (const JsonValue* pose = reader.find("goal")) {
    read.goal_at = pose->begins();
    const JsonPath goal_path = reader.path("goal");
    robot.goal = parse_pose(*pose, goal_path, frame, faults);
  }
  read.placed = start.has_value() && traits.values[0].has_value();
  return read;
}

}  // namespace

std::vector<ReadRobot> parse_robots(const JsonValue& robots, const JsonPath& robots_path,
                                    const JsonValue* defaults, const JsonPath& defaults_path,
                                    const WorldFrame& frame, std::size_t max_robots, FaultList& faults) {
  Traits common;
  if (defaults != nullptr) {
    common = parse_traits(ObjectReader(*defaults, defaults_path, kTraits, faults), faults);
  }
  std::vector<ReadRobot> read;
  const JsonValue::Array* items = read_array(robots, robots_path, faults);
  if (items == nullptr) return read;
  if (items->empty()) faults.add(robots, robots_path, fault::kEmpty, "robots must hold at least one robot.");
  if (items->size() > max_robots) {
    faults.add(robots, robots_path, fault::kOutOfRange,
               "There are " + std::to_string(items->size()) + " robots; this service takes at most " +
                   std::to_string(max_robots) + ".");
    return read;
  }
  std::unordered_map<std::string, std::size_t> owner;  // of each id, the first robot that has it
  for (std::size_t index = 0; index < items->size(); ++index) {
    const JsonValue& item = (*items)[index];
    const JsonPath path = robots_path / index;
    read.push_back(parse_robot(item, path, common, frame, faults));
    const std::string& id = read.back().robot.id;
    if (id.empty()) continue;
    const auto [first, is_new] = owner.emplace(id, index);
    if (is_new) continue;
    faults.add(*item.find("id"), path / "id", fault::kDuplicate,
               "Robots " + std::to_string(first->second) + " and " + std::to_string(index) +
                   " (from 0) both have the id " + in_quotes(id) + "; ids must be unique.");
  }
  return read;
}

}  // namespace fleetplan::api
