// Zones of requests. Their shapes are polygons, or masks, which are images of the map.

#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>
#include <numbers>
#include <numeric>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "api/json/errors.h"
#include "api/request/fleet/parse_robots.h"
#include "api/request/limits.h"
#include "api/request/map/parse_map.h"
#include "api/request/map/parse_mask.h"
#include "api/request/shared_members.h"
#include "core/geometry/position.h"
#include "core/model/surroundings.h"

namespace fleetplan::api {

namespace {

using Corners = std::vector<core::Position>;

constexpr std::array<std::string_view, 2> kCornerMembers{"x", "y"};
constexpr std::size_t kFewestCorners = 3;
/// The most corners of one polygon. In the worst case, every side is compared with every other side.
constexpr std::size_t kMaxCorners = 1000;
/// The work of comparing two sides, in bytes of text.
constexpr std::size_t kWorkOfAComparison = 8;

double turn(const core::Position& a, const core::Position& b, const core::Position& c) {
  return core::cross_product(b - a, c - a);
}

/// Whether a point on the line of a segment lies within its box.
bool lies_between(const core::Position& a, const core::Position& b, const core::Position& point) {
  return point.x() >= std::min(a.x(), b.x()) && point.x() <= std::max(a.x(), b.x()) &&
         point.y() >= std::min(a.y(), b.y()) && point.y() <= std::max(a.y(), b.y());
}

/// Whether two segments have a point in common.
bool meet(const core::Position& a, const core::Position& b, const core::Position& c,
          const core::Position& d) {
  const double abc = turn(a, b, c);
  const double abd = turn(a, b, d);
  const double cda = turn(c, d, a);
  const double cdb = turn(c, d, b);
  const auto differ = [](double p, double q) { return (p > 0.0 && q < 0.0) || (p < 0.0 && q > 0.0); };
  if (differ(abc, abd) && differ(cda, cdb)) return true;
  return (abc == 0.0 && lies_between(a, b, c)) || (abd == 0.0 && lies_between(a, b, d)) ||
         (cda == 0.0 && lies_between(c, d, a)) || (cdb == 0.0 && lies_between(c, d, b));
}

/// The sides of a polygon; side k leads from corner k to the next one.
class Sides {
 public:
  explicit Sides(const Corners& corners) : corners_(corners) {}

  /// Returns two sides that meet elsewhere than at their common corner, the earlier one first. None if there
  /// are no such sides, or if the reading is stopped.
  std::optional<std::pair<std::size_t, std::size_t>> touching_sides(core::Work& work) const {
    std::vector<std::size_t> order(corners_.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) { return left(i) < left(j); });
    for (std::size_t i = 0; i < order.size(); ++i) {
      for (std::size_t j = i + 1; j < order.size() && left(order[j]) <= right(order[i]); ++j) {
        if (work.met_after(kWorkOfAComparison)) return std::nullopt;
        const auto [first, second] = std::minmax(order[i], order[j]);
        if (are_at_fault(first, second)) return std::pair(first, second);
      }
    }
    return std::nullopt;
  }

 private:
  const core::Position& begin(std::size_t side) const { return corners_[side]; }
  const core::Position& end(std::size_t side) const { return corners_[(side + 1) % corners_.size()]; }
  double left(std::size_t side) const { return std::min(begin(side).x(), end(side).x()); }
  double right(std::size_t side) const { return std::max(begin(side).x(), end(side).x()); }

  bool are_at_fault(std::size_t first, std::size_t second) const {
    if (second == first + 1) return leads_back(first, second);
    if (first == 0 && second + 1 == corners_.size()) return leads_back(second, first);
    return meet(begin(first), end(first), begin(second), end(second));
  }

  /// Whether the next side leads back along this side.
  bool leads_back(std::size_t side, std::size_t next) const {
    return turn(begin(side), end(side), end(next)) == 0.0 &&
           (end(side) - begin(side)).dot(end(next) - begin(next)) < 0.0;
  }

  const Corners& corners_;
};

/// Reads corners, in the map frame. Returns none if one has a fault.
Corners parse_corners(const JsonReader& list, const WorldFrame& frame) {
  const std::size_t faults = list.fault_count();
  Corners corners;
  corners.reserve(list.size());
  for (const JsonReader item : list.items()) {
    const JsonReader json = item.object(kCornerMembers);
    if (!json) continue;
    const auto x = json.require("x").number(kCoordinate);
    const auto y = json.require("y").number(kCoordinate);
    if (!x || !y) continue;
    const core::Position corner = frame.to_map({*x, *y});
    if (!corners.empty() && corners.back() == corner) {
      item.fault(fault::kBadPolygon, "This corner equals the one before; leave it out.");
    }
    corners.push_back(corner);
  }
  if (corners.size() > 1 && corners.front() == corners.back()) {
    list.item(list.size() - 1)
        .fault(fault::kBadPolygon,
               "The last corner equals the first one; leave it out, the polygon is closed.");
  }
  return list.fault_count() == faults ? corners : Corners{};
}

/// Reads the corners of a simple polygon, in the map frame. All polygons together take their corners from the
/// quota. These are faults; then no corners are returned:
///
/// - fewer than three corners,
/// - a corner that equals the previous one,
/// - sides that meet elsewhere than at their common corner.
std::vector<core::Position> parse_polygon(const JsonReader& member, const WorldFrame& frame, Quota& corners) {
  const JsonReader list = member.array();
  if (!list || !corners.take(list)) return {};
  if (list.size() < kFewestCorners) {
    list.fault(fault::kBadPolygon,
               "polygon must have at least 3 corners, not " + std::to_string(list.size()) + '.');
    return {};
  }
  if (list.size() > kMaxCorners) {
    list.fault(fault::kOutOfRange, "polygon has " + std::to_string(list.size()) + " corners; it may have " +
                                       std::to_string(kMaxCorners) + ". Divide it into several zones.");
    return {};
  }
  Corners read = parse_corners(list, frame);
  if (read.empty()) return {};
  if (const auto met = Sides(read).touching_sides(list.work())) {
    const std::string first = std::to_string(met->first);
    const std::string second = std::to_string(met->second);
    list.fault(fault::kBadPolygon,
               "The sides that begin at the corners " + first + " and " + second +
                   " (from 0) cross or touch each other; list the corners in order along the border, and "
                   "divide an area that touches itself into several zones.");
    return {};
  }
  return read;
}

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
        limits_(limits),
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

  /// What masks may mean otherwise.
  const MaskNotes& notes() const { return notes_; }

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
    const MaskKind kind = zone.type == Type::speed ? MaskKind::speed : MaskKind::blocked;
    for (const MaskPart& part : parse_mask(mask, *map_, kind, limits_, corners_, zone.id, notes_)) {
      if (mask.work().met_after(kWorkOfAPart)) return {};
      core::Zone& cells = zones.emplace_back(zone);
      cells.polygon = part.polygon;
      if (zone.type == Type::speed) cells.linear_speed_share = part.speed_share;
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
  const Limits& limits_;
  MaskNotes notes_;
  Quota corners_;
  RobotNames names_;
  std::size_t not_there_;
  ZoneRobots named_;
  std::unordered_map<std::string, std::size_t> zones_;  // their numbers by id
  std::size_t count_ = 0;
};

}  // namespace

std::vector<core::Zone> parse_zones(const JsonReader& member, const WorldMap* map, const Limits& limits,
                                    const std::vector<ParsedRobot>& robots,
                                    std::vector<std::string>& warnings, ZoneRobots named) {
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
  reader.notes().tell(warnings);
  return zones;
}

}  // namespace fleetplan::api
