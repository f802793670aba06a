#include "api/request/parse_robots.h"

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>

#include "api/json/fault_text.h"
#include "api/request/ranges.h"
#include "core/geometry/angle.h"

namespace fleetplan::api {

namespace {

constexpr std::array<std::string_view, 6> kMembers{"id",    "radius", "linear_speed", "angular_speed",
                                                   "start", "goal"};
constexpr std::array<std::string_view, 3> kPoseMembers{"x", "y", "theta"};

// The members that `robot_defaults` can give as well.
constexpr std::array<std::string_view, 3> kTraits{"radius", "linear_speed", "angular_speed"};
constexpr std::array<Range, 3> kTraitRanges{kLength, kLinearSpeed, kAngularSpeed};

/// Which traits are given, and the valid ones among them.
struct Traits {
  std::array<bool, 3> given{};
  std::array<std::optional<double>, 3> values;
};

Traits parse_traits(const JsonReader& json) {
  Traits traits;
  for (std::size_t trait = 0; trait < kTraits.size(); ++trait) {
    const JsonReader member = json.find(kTraits[trait]);
    traits.given[trait] = static_cast<bool>(member);
    traits.values[trait] = member.number(kTraitRanges[trait]);
  }
  return traits;
}

/// A robot's traits, completed by the defaults. What neither gives is missing; an invalid default is a fault
/// already.
Traits parse_traits(const JsonReader& robot, const Traits& defaults) {
  Traits traits = parse_traits(robot);
  for (std::size_t trait = 0; trait < kTraits.size(); ++trait) {
    if (traits.given[trait]) continue;
    if (defaults.given[trait]) {
      traits.values[trait] = defaults.values[trait];
    } else {
      robot.require(kTraits[trait], ", here and in robot_defaults; give it in one of them");
    }
  }
  return traits;
}

/// A pose with or without a heading, in the map frame. Nothing when it is absent or has a fault.
std::optional<core::Goal> parse_pose(const JsonReader& member, const WorldFrame& frame) {
  const std::size_t before = member.fault_count();
  const JsonReader json = member.object(kPoseMembers);
  const auto x = json.require("x").number(kCoordinate);
  const auto y = json.require("y").number(kCoordinate);
  const auto theta = json.find("theta").number(kAnyAngle);
  if (!x || !y || member.fault_count() != before) return std::nullopt;
  core::Goal pose;
  pose.position = frame.to_map({*x, *y});
  if (theta) pose.theta = core::normalize_angle(*theta);
  return pose;
}

ReadRobot parse_robot(const JsonReader& item, const Traits& defaults, const WorldFrame& frame) {
  const JsonReader json = item.object(kMembers);
  ReadRobot read;
  if (!json) return read;
  core::Robot& robot = read.robot;
  robot.id = json.require("id").name().value_or("");
  const Traits traits = parse_traits(json, defaults);
  robot.radius = traits.values[0].value_or(1.0);
  robot.linear_speed = traits.values[1].value_or(1.0);
  robot.angular_speed = traits.values[2].value_or(1.0);
  read.start = json.require("start", "; give {\"x\", \"y\"} and optionally \"theta\"");
  const auto start = parse_pose(read.start, frame);
  if (start) robot.start = {start->position, start->theta.value_or(0.0)};
  read.goal = json.find("goal");
  robot.goal = parse_pose(read.goal, frame);
  read.placed = start.has_value() && traits.values[0].has_value();
  return read;
}

/// Reports every id that an earlier robot has.
class UniqueIds {
 public:
  /// `item`: of the robot with this index.
  void check(const std::string& id, std::size_t index, const JsonReader& item) {
    if (id.empty()) return;
    const auto [first, is_new] = owner_.emplace(id, index);
    if (is_new) return;
    item.find("id").fault(fault::kDuplicate, [&, earlier = first->second] {
      return "Robots " + std::to_string(earlier) + " and " + std::to_string(index) +
             " (from 0) both have the id " + in_quotes(id) + "; ids must be unique.";
    });
  }

 private:
  std::unordered_map<std::string, std::size_t> owner_;  // of each id, the first robot that has it
};

}  // namespace

std::vector<ReadRobot> parse_robots(const JsonReader& robots, const JsonReader& defaults,
                                    const WorldFrame& frame, std::size_t max_robots) {
  if (!robots) return {};
  const Traits common = parse_traits(defaults.object(kTraits));
  const JsonReader items = robots.array();
  if (!items) return {};
  if (items.size() == 0) items.fault(fault::kEmpty, "robots must contain at least one robot.");
  if (items.size() > max_robots) {
    items.fault(fault::kOutOfRange, "There are " + std::to_string(items.size()) +
                                        " robots; this service accepts at most " +
                                        std::to_string(max_robots) + ".");
    return {};
  }
  std::vector<ReadRobot> read;
  read.reserve(items.size());
  UniqueIds ids;
  for (const JsonReader item : items.items()) {
    read.push_back(parse_robot(item, common, frame));
    ids.check(read.back().robot.id, read.size() - 1, item);
  }
  return read;
}

}  // namespace fleetplan::api
