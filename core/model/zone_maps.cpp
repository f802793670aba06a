#include "core/model/zone_maps.h"

#include <algorithm>
#include <map>
#include <utility>

#include "core/geometry/polygon.h"

namespace fleetplan::core {
namespace {

using Zones = std::vector<std::size_t>;  // indices, ascending

Zones blocked_for(std::size_t robot, const std::vector<Zone>& zones) {
  Zones blocked;
  for (std::size_t k = 0; k < zones.size(); ++k) {
    if (zones[k].type == Zone::Type::blocked && zones[k].is_for(robot)) blocked.push_back(k);
  }
  return blocked;
}

std::shared_ptr<const StaticMap> with_zones(const std::shared_ptr<const StaticMap>& map, const Zones& blocked,
                                            const std::vector<Zone>& zones) {
  std::vector<Polygon> polygons;
  for (const std::size_t k : blocked) polygons.emplace_back(zones[k].polygon);
  return std::make_shared<StaticMap>(map, std::move(polygons));
}

}  // namespace

ZoneMaps::ZoneMaps(std::shared_ptr<const StaticMap> map, const std::vector<Zone>& zones, std::size_t robots,
                   const StopCondition& stop)
    : maps_{std::move(map)} {
  const bool any = std::any_of(zones.begin(), zones.end(),
                               [](const Zone& zone) { return zone.type == Zone::Type::blocked; });
  if (!any) return;
  std::map<Zones, std::size_t> known{{{}, 0}};
  for (std::size_t robot = 0; robot < robots; ++robot) {
    if (stop.met()) {
      finished_ = false;
      return;
    }
    const Zones blocked = blocked_for(robot, zones);
    const auto [found, is_new] = known.emplace(blocked, maps_.size());
    if (is_new) maps_.push_back(with_zones(maps_.front(), blocked, zones));
    map_of_.push_back(found->second);
  }
}

double distance_to_zone(const Zone& zone, const Position& position) {
  const Polygon polygon(zone.polygon);
  return polygon.contains(position) ? 0.0 : polygon.distance_to_border(position);
}

std::optional<NearestZone> nearest_blocked_zone(const std::vector<Zone>& zones, std::size_t robot,
                                                const Position& position, double reach) {
  std::optional<NearestZone> nearest;
  for (std::size_t k = 0; k < zones.size(); ++k) {
    if (zones[k].type != Zone::Type::blocked || !zones[k].is_for(robot)) continue;
    const double distance = distance_to_zone(zones[k], position);
    if (distance < (nearest ? nearest->distance : reach)) nearest = NearestZone{k, distance};
  }
  return nearest;
}

}  // namespace fleetplan::core
