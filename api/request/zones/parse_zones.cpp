#include "api/request/zones/parse_zones.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <numbers>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>

#include "api/json/faults.h"
#include "api/request/fleet/parse_robots.h"
#include "api/request/ranges.h"
#include "api/request/shared_members.h"
#include "api/request/zones/zone_shapes.h"
#include "core/geometry/angle.h"

namespace fleetplan::api {

namespace {

using Type = core::Zone::Type;

constexpr std::array<std::string_view, 3> kTypes{"blocked", "speed", "one_way"};  // see core::Zone::Type
constexpr std::array<std::string_view, 10> kMembers{"id",      "type",      "enter",        "polygon",
                                                    "mask",    "robots",    "linear_speed", "angular_speed",
                                                    "heading", "half_angle"};
/// The work of making a zone of a part of a mask, in bytes of text.
constexpr std::size_t kWorkOfAPart = 64;
constexpr Range kHalfAngle{kLeastHalfAngle, std::numbers::pi, "radians"};

class ZoneReader {
 public:
  ZoneReader(const WorldMap* map, const Limits& limits, const std::vector<ParsedRobot>& robots,
             ZoneRobots named)
      : map_(map),
        corners_(limits.max_zone_corners, "corners of zones"),
        names_(robots),
        not_there_(robots.size()),
        named_(named) {}

  /// Reads a zone, or the parts of its mask.
  std::vector<core::Zone> read(const JsonReader& item) {
    core::Zone zone;
    const JsonReader json = item.object(kMembers);
    if (!json) return {};
    read_id(json.require("id"), zone);
    const JsonReader type = json.require("type", "; give one of " + listed(kTypes));
    if (const auto word = type.word(kTypes)) {
      zone.type = static_cast<Type>(*word);
      read_rule(json, zone);
      read_enter(json.find("enter"), zone);
    }
    read_robots(json.find("robots"), zone);
    if (const JsonReader mask = json.find("mask")) return read_mask(json, mask, zone);
    const JsonReader polygon = json.require("polygon", "; give a list of {\"x\", \"y\"}, or a mask");
    zone.polygon = parse_polygon(polygon, map_ != nullptr ? map_->frame : WorldFrame{}, corners_);
    if (zone.polygon.empty()) return {};  // also without a fault of its own: beyond the quota of corners
    return {zone};
  }

 private:
  void read_id(const JsonReader& member, core::Zone& zone) {
    zone.id = member.name().value_or("");
    const std::size_t index = count_++;
    if (zone.id.empty()) return;
    const auto [first, is_new] = zones_.emplace(zone.id, index);
    if (is_new) return;
    member.fault(fault::kDuplicate, [&, earlier = first->second] {
      return "Zones " + std::to_string(earlier) + " and " + std::to_string(index) +
             " (from 0) both have the id " + in_quotes(zone.id) + "; ids of zones must be unique.";
    });
  }

  std::vector<core::Zone> read_mask(const JsonReader& json, const JsonReader& mask, const core::Zone& zone) {
    if (const JsonReader polygon = json.find("polygon")) {
      polygon.fault(fault::kDuplicate, "The zone has both a polygon and a mask; give one of them.");
    }
    if (zone.type == Type::one_way) {
      mask.fault(fault::kUnknownKey,
                 "mask is for zones of the types blocked and speed only; give a polygon.");
    }
    if (map_ == nullptr) return {};
    std::vector<core::Zone> zones;
    for (const MaskPart& part : parse_mask(mask, map_->grid, zone.type == Type::speed, corners_)) {
      if (mask.stop().met_after(kWorkOfAPart)) return {};
      core::Zone& cells = zones.emplace_back(zone);
      cells.polygon = part.polygon;
      if (zone.type == Type::speed) cells.linear_speed_share = part.percent / 100.0;
    }
    return zones;
  }

  static void read_rule(const JsonReader& json, core::Zone& zone) {
    for (const auto& [key, type] : {std::pair{"linear_speed", Type::speed},
                                    {"angular_speed", Type::speed},
                                    {"heading", Type::one_way},
                                    {"half_angle", Type::one_way}}) {
      const JsonReader member = json.find(key);
      if (!member || type == zone.type) continue;
      member.fault(fault::kUnknownKey, std::string(key) + " is for zones of the type " +
                                           std::string(kTypes[static_cast<std::size_t>(type)]) +
                                           " only; leave it out, or change the type.");
    }
    if (zone.type == Type::speed && !json.find("mask")) read_speeds(json, zone);
    if (zone.type == Type::speed && json.find("mask")) refuse_speeds(json);
    if (zone.type != Type::one_way) return;
    zone.heading = core::normalize_angle(
        json.require("heading", "; give the direction of travel").number(kAnyAngle).value_or(0.0));
    zone.half_angle = json.require("half_angle", "; give how far from heading a robot may move")
                          .number(kHalfAngle)
                          .value_or(0.0);
  }

  static void read_enter(const JsonReader& member, core::Zone& zone) {
    const auto enter = member.boolean();
    if (!enter) return;
    if (zone.type != Type::blocked) {
      member.fault(fault::kUnknownKey,
                   "enter is for zones of the type blocked only; leave it out, or change the type.");
    } else if (*enter) {
      member.fault(fault::kOutOfRange,
                   "enter must be false: nobody enters a blocked zone. Leave it out for a zone in which no "
                   "robot may be from the first; with false, robots that are inside may leave.");
    }
    zone.may_leave = true;
  }

  static void refuse_speeds(const JsonReader& json) {
    for (const char* key : {"linear_speed", "angular_speed"}) {
      if (const JsonReader member = json.find(key)) {
        member.fault(
            fault::kUnknownKey,
            std::string(key) + " is for zones with a polygon; the mask has the speeds. Leave it out.");
      }
    }
  }

  static void read_speeds(const JsonReader& json, core::Zone& zone) {
    const JsonReader linear = json.find("linear_speed");
    const JsonReader angular = json.find("angular_speed");
    if (!linear && !angular) {
      json.require("linear_speed", "; a zone of the type speed has linear_speed, angular_speed or both");
    }
    zone.linear_speed = linear.number(kLinearSpeed).value_or(core::Zone::kNoLimit);
    zone.angular_speed = angular.number(kAngularSpeed).value_or(core::Zone::kNoLimit);
  }

  void read_robots(const JsonReader& member, core::Zone& zone) const {
    const JsonReader list = member.array();
    if (!list) return;
    if (list.size() == 0) {
      list.fault(fault::kEmpty,
                 "robots must name at least one robot; leave it out for a zone for all robots.");
    }
    for (const JsonReader item : list.items()) {
      const auto robot = index_of(item);
      if (!robot) continue;
      const auto place = std::lower_bound(zone.robots.begin(), zone.robots.end(), *robot);
      if (place != zone.robots.end() && *place == *robot) {
        if (*robot == not_there_) continue;
        item.fault(fault::kDuplicate, [&] {
          return "The robot " + in_quotes(*item.string()) + " is already in this list; name it once.";
        });
        continue;
      }
      zone.robots.insert(place, *robot);
    }
  }

  std::optional<std::size_t> index_of(const JsonReader& item) const {
    if (named_ == ZoneRobots::of_request) return names_.find(item);
    const auto name = item.name();
    if (!name) return std::nullopt;
    return names_.index_of(*name).value_or(not_there_);
  }

  const WorldMap* map_;
  Quota corners_;
  RobotNames names_;
  std::size_t not_there_;
  ZoneRobots named_;
  std::unordered_map<std::string, std::size_t> zones_;  // their numbers by id
  std::size_t count_ = 0;
};

}  // namespace

std::vector<core::Zone> parse_zones(const JsonReader& member, const WorldMap* map, const Limits& limits,
                                    const std::vector<ParsedRobot>& robots, ZoneRobots named) {
  const JsonReader items = member.array();
  if (!items) return {};
  Quota quota(limits.max_zones, "zones");
  if (!quota.take(items)) return {};
  ZoneReader reader(map, limits, robots, named);
  std::vector<core::Zone> zones;
  zones.reserve(items.size());
  for (const JsonReader item : items.items()) {
    const std::size_t faults = item.fault_count();
    std::vector<core::Zone> read = reader.read(item);
    if (item.fault_count() != faults) continue;
    zones.insert(zones.end(), std::make_move_iterator(read.begin()), std::make_move_iterator(read.end()));
  }
  return zones;
}

}  // namespace fleetplan::api
