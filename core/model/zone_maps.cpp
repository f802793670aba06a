#include "core/model/zone_maps.h"

#include <algorithm>
#include <map>
#include <utility>

#include "core/geometry/polygon.h"

namespace fleetplan::core {
namespace {

using Zones = std::vector<std::size_t>;  // indices, ascending

template <class Counts>
Zones zones_of(std::size_t robot, const std::vector<Zone>& zones, const Counts& counts) {
  Zones found;
  for (std::size_t k = 0; k < zones.size(); ++k) {
    if (counts(zones[k]) && zones[k].is_for(robot)) found.push_back(k);
  }
  return found;
}

bool is_blocked(const Zone& zone) { return zone.type == Zone::Type::blocked; }
bool is_wall(const Zone& zone) { return zone.is_wall(); }
bool is_to_leave(const Zone& zone) { return is_blocked(zone) && zone.may_leave; }

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
  if (std::none_of(zones.begin(), zones.end(), is_blocked)) return;
  const bool any_to_leave = std::any_of(zones.begin(), zones.end(), is_to_leave);
  std::map<Zones, std::size_t> known{{{}, 0}};
  const auto map_with = [&](const Zones& blocked) {
    const auto [found, is_new] = known.emplace(blocked, maps_.size());
    if (is_new) maps_.push_back(with_zones(maps_.front(), blocked, zones));
    return found->second;
  };
  for (std::size_t robot = 0; robot < robots; ++robot) {
    if (stop.met()) {
      finished_ = false;
      return;
    }
    map_of_.push_back(map_with(zones_of(robot, zones, is_blocked)));
    if (any_to_leave) leaving_map_of_.push_back(map_with(zones_of(robot, zones, is_wall)));
  }
}

double distance_to_zone(const Zone& zone, const Position& position) {
  const Polygon polygon(zone.polygon);
  return polygon.contains(position) ? 0.0 : polygon.distance_to_border(position);
}

namespace {

template <class Counts>
std::optional<NearestZone> nearest_zone(const std::vector<Zone>& zones, std::size_t robot,
                                        const Position& position, double reach, const Counts& counts) {
  std::optional<NearestZone> nearest;
  for (std::size_t k = 0; k < zones.size(); ++k) {
    if (!counts(zones[k]) || !zones[k].is_for(robot)) continue;
    const double distance = distance_to_zone(zones[k], position);
    if (distance < (nearest ? nearest->distance : reach)) nearest = NearestZone{k, distance};
  }
  return nearest;
}

}  // namespace

std::optional<NearestZone> nearest_blocked_zone(const std::vector<Zone>& zones, std::size_t robot,
                                                const Position& position, double reach) {
  return nearest_zone(zones, robot, position, reach, is_wall);
}

std::optional<NearestZone> nearest_zone_to_leave(const std::vector<Zone>& zones, std::size_t robot,
                                                 const Position& position, double reach) {
  return nearest_zone(zones, robot, position, reach, is_to_leave);
}

}  // namespace fleetplan::core
