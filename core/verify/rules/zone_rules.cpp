#include "core/verify/rules/zone_rules.h"

#include <algorithm>
#include <string>
#include <utility>

#include "core/geometry/tolerance.h"
#include "core/verify/geometry/segment_to_polygon.h"
#include "core/verify/quantity_text.h"

namespace fleetplan::core {
namespace {

Rectangle box_of(const std::vector<Position>& corners) {
  Rectangle box{corners.front(), corners.front()};
  for (const Position& corner : corners) {
    box.low = box.low.cwiseMin(corner);
    box.high = box.high.cwiseMax(corner);
  }
  return box;
}

/// The nearest point of a segment to a zone, if that is nearer than `reach`.
std::optional<NearestPoint> nearest_to_zone(const Position& from, const Position& to, const Zone& zone,
                                            const Rectangle& box, double reach) {
  if (nearest_to_rectangle(from, to, box).distance >= reach) return std::nullopt;
  const NearestPoint nearest = nearest_to_polygon(from, to, zone.polygon);
  return nearest.distance < reach ? std::optional(nearest) : std::nullopt;
}

/// The time at a fraction of a leg; the final rest has no end.
double moment(const Leg& leg, double fraction) {
  return fraction > 0.0 ? leg.t_begin + fraction * (leg.t_end - leg.t_begin) : leg.t_begin;
}

std::string blocked_text(const Zone& zone, double distance, double radius, double t) {
  const std::string where = "blocked zone \"" + zone.id + "\" at t = " + seconds(t);
  return distance > 0.0 ? "the disk reaches " + metres(radius - distance) + " into the " + where
                        : "the centre of the disk reaches the " + where;
}

}  // namespace

ZonesOfRobot::ZonesOfRobot(const std::vector<Zone>* zones, std::size_t robot) : robot_(robot) {
  if (zones == nullptr) return;
  for (std::size_t k = 0; k < zones->size(); ++k) {
    const Zone& zone = (*zones)[k];
    if (zone.is_for(robot)) zones_.push_back({k, &zone, box_of(zone.polygon)});
  }
}

double ZonesOfRobot::distance_to_blocked(const Position& position, double reach) const {
  double least = reach;
  for (const auto& [index, zone, box] : zones_) {
    if (zone->type != Zone::Type::blocked) continue;
    if (const auto nearest = nearest_to_zone(position, position, *zone, box, least))
      least = nearest->distance;
  }
  return least;
}

ViolationList ZonesOfRobot::check_blocked(const std::vector<double>& radii, const std::vector<Leg>& legs,
                                          double tolerance, const StopCondition& stop) const {
  ViolationList violations;
  for (const auto& [index, zone, box] : zones_) {
    if (zone->type != Zone::Type::blocked) continue;
    std::optional<Violation> latest;  // of consecutive legs
    for (std::size_t k = 0; k < legs.size(); ++k) {
      if (stop.met()) return violations;
      const Leg& leg = legs[k];
      const auto nearest = nearest_to_zone(leg.from, leg.to, *zone, box, radii[k] - tolerance);
      if (!nearest) {
        if (latest) violations.add(*std::exchange(latest, std::nullopt));
        continue;
      }
      if (latest && nearest->distance >= latest->distance - kSamePosition) continue;
      const double t = moment(leg, nearest->fraction);
      latest =
          Violation{Violation::Kind::zone, {robot_}, t,
                    nearest->distance,     radii[k], blocked_text(*zone, nearest->distance, radii[k], t)};
      latest->zone = index;
    }
    if (latest) violations.add(std::move(*latest));
  }
  return violations;
}

}  // namespace fleetplan::core
