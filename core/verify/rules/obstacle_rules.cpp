#include "core/verify/rules/obstacle_rules.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "core/geometry/tolerance.h"
#include "core/verify/quantity_text.h"

namespace fleetplan::core {
namespace {

constexpr double kNone = std::numeric_limits<double>::infinity();

double time_at(const Leg& leg, double fraction) {
  return fraction > 0.0 ? leg.t_begin + fraction * (leg.t_end - leg.t_begin) : leg.t_begin;
}

Violation overlap_with(const NearestObstacle& obstacle, std::size_t robot, double radius, double t) {
  const double distance = obstacle.point.distance;
  std::string detail;
  if (distance > 0.0) {
    detail = "the disk reaches " + metres(radius - distance) +
             (obstacle.is_edge ? " beyond the edge of the map" : " into a blocked cell");
  } else {
    detail = obstacle.is_edge ? "the centre of the disk reaches the edge of the map"
                              : "the centre of the disk reaches a blocked cell";
  }
  detail += " at t = " + seconds(t);
  return {Violation::Kind::obstacle_collision, {robot}, t, distance, radius, detail};
}

}  // namespace

double distance_from_walls(const ObstacleField& field, const Position& position, double reach) {
  const auto nearest = field.nearest(position, position, reach);
  return nearest ? nearest->point.distance : reach;
}

std::vector<double> distances_to_keep(const std::function<double(const Position&, double)>& distance_from,
                                      const std::vector<double>& radii, const std::vector<Leg>& legs,
                                      const Departure& departure, double tolerance, const CheckRules& rules) {
  std::vector<double> kept = radii;
  if (rules.inflation <= 0.0 && rules.start_overlap <= 0.0) return kept;
  double reduced = kNone;  // what it keeps until it has been clear
  bool planned = false;
  for (std::size_t k = 0; k < legs.size(); ++k) {
    const double radius = radii[k];
    const double inflated = radius + rules.inflation;
    const double full = departure.commits(legs[k].t_end) ? radius : inflated;
    const bool begins_to_plan = !planned && !departure.commits(legs[k].t_end);
    planned = planned || begins_to_plan;
    if (k == 0 || begins_to_plan) {
      const double here = distance_from(legs[k].from, full);
      const bool measured = k == 0 && inflated - here <= rules.start_overlap + tolerance;
      if (here < full && (measured || here >= radius - tolerance)) reduced = std::min(here, reduced);
    }
    kept[k] = std::min(full, reduced);
    if (reduced < full && distance_from(legs[k].to, full) >= full - tolerance) reduced = kNone;
  }
  return kept;
}

ViolationList check_obstacles(const ObstacleField& field, std::size_t robot, const std::vector<double>& radii,
                              const std::vector<Leg>& legs, double tolerance, const StopCondition& stop) {
  ViolationList violations;
  std::optional<Violation> latest;   // may continue
  const Leg* overlapping = nullptr;  // the previous leg, if it overlaps an obstacle
  for (std::size_t k = 0; k < legs.size(); ++k) {
    if (stop.met()) break;
    const Leg& leg = legs[k];
    const double radius = radii[k];
    const double reach = radius - tolerance;
    const std::optional<NearestObstacle> nearest = field.nearest(leg.from, leg.to, reach);
    if (!nearest) {
      overlapping = nullptr;
      continue;
    }
    // Along a wall only rounding makes one moment the deepest; the overlap then begins with the leg.
    const double distance = nearest->point.distance;
    const std::optional<NearestObstacle> at_first = field.nearest(leg.from, leg.from, reach);
    const bool from_the_beginning = at_first && at_first->point.distance <= distance + kSamePosition;
    const double t = time_at(leg, from_the_beginning ? 0.0 : nearest->point.fraction);

    const bool continues = overlapping != nullptr && overlapping->to == leg.from && at_first;
    overlapping = &leg;
    if (!continues) {
      if (latest) violations.add(std::move(*latest));
      latest = overlap_with(*nearest, robot, radius, t);
    } else if (distance < latest->distance - kSamePosition) {
      latest = overlap_with(*nearest, robot, radius, t);
    }
  }
  if (latest) violations.add(std::move(*latest));
  return violations;
}

}  // namespace fleetplan::core
