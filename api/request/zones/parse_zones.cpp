#include "api/request/zones/parse_zones.h"

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>

#include "api/json/fault_text.h"
#include "api/request/motion/quota.h"
#include "api/request/ranges.h"
#include "api/request/zones/parse_polygon.h"

namespace fleetplan::api {

namespace {

constexpr std::array<std::string_view, 1> kTypes{"blocked"};  // as in core::Zone::Type
constexpr std::array<std::string_view, 4> kMembers{"id", "type", "polygon", "robots"};

/// The ids of the robots and of the zones, with their numbers.
using Ids = std::unordered_map<std::string, std::size_t>;

class ZoneReader {
 public:
  ZoneReader(const WorldFrame& frame, const Limits& limits, const std::vector<ReadRobot>& robots)
      : frame_(frame), corners_(limits.max_zone_corners, "corners of zones") {
    for (std::size_t index = 0; index < robots.size(); ++index) {
      robots_.emplace(robots[index].robot.id, index);
    }
  }

  core::Zone read(const JsonReader& item) {
    core::Zone zone;
    const JsonReader json = item.object(kMembers);
    if (!json) return zone;
    read_id(json.require("id"), zone);
    const JsonReader type = json.require("type", "; give one of " + listed(kTypes));
    if (const auto word = type.word(kTypes)) zone.type = static_cast<core::Zone::Type>(*word);
    const JsonReader polygon = json.require("polygon", "; give a list of {\"x\", \"y\"}");
    zone.polygon = parse_polygon(polygon, frame_, corners_);
    read_robots(json.find("robots"), zone);
    return zone;
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

  void read_robots(const JsonReader& member, core::Zone& zone) const {
    const JsonReader list = member.array();
    if (!list) return;
    if (list.size() == 0) {
      list.fault(fault::kEmpty,
                 "robots must name at least one robot; leave it out for a zone for all robots.");
    }
    for (const JsonReader item : list.items()) {
      const auto id = item.name();
      if (!id) continue;
      const auto found = robots_.find(*id);
      if (found == robots_.end()) {
        item.fault(fault::kUnknownRobot,
                   [&] { return "There is no robot " + in_quotes(*id) + " in robots."; });
        continue;
      }
      const auto place = std::lower_bound(zone.robots.begin(), zone.robots.end(), found->second);
      if (place != zone.robots.end() && *place == found->second) {
        item.fault(fault::kDuplicate,
                   [&] { return "The robot " + in_quotes(*id) + " is already in this list; name it once."; });
        continue;
      }
      zone.robots.insert(place, found->second);
    }
  }

  const WorldFrame& frame_;
  Quota corners_;
  Ids robots_;
  Ids zones_;
  std::size_t count_ = 0;
};

}  // namespace

std::vector<core::Zone> parse_zones(const JsonReader& member, const WorldFrame& frame, const Limits& limits,
                                    const std::vector<ReadRobot>& robots) {
  const JsonReader items = member.array();
  if (!items) return {};
  Quota quota(limits.max_zones, "zones");
  if (!quota.take(items)) return {};
  ZoneReader reader(frame, limits, robots);
  std::vector<core::Zone> zones;
  zones.reserve(items.size());
  for (const JsonReader item : items.items()) {
    const std::size_t faults = item.fault_count();
    core::Zone zone = reader.read(item);
    if (item.fault_count() == faults) zones.push_back(std::move(zone));
  }
  return zones;
}

}  // namespace fleetplan::api
