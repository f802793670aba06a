#include "core/execution/simulation/collisions.h"

#include <algorithm>
#include <cmath>

#include "core/verify/geometry/relative_motion.h"
#include "core/verify/pairs/fleet_clearance.h"

namespace fleetplan::core {
namespace {

/// The overlaps of one execution that are told apart: many robots in one place have millions of them.
constexpr std::size_t kMostOverlaps = 10'000;

/// A leg takes as long as there are blocked cells near it.
constexpr std::size_t kLegsBetweenPolls = 8;

bool is_earlier(const ExecutedCollision& a, const ExecutedCollision& b) {
  return a.t != b.t ? a.t < b.t : a.first < b.first;
}

Position position_of(const std::vector<Leg>& legs, double t) {
  return position_at(*first_leg_until(legs, t), t);
}

}  // namespace

std::optional<ExecutedCollision> find_wall(const ObstacleField& field, std::size_t robot,
                                           const std::vector<Leg>& legs, double radius, double tolerance,
                                           const StopCondition& stop) {
  const double reach = radius - tolerance;
  if (reach <= 0.0) return std::nullopt;
  for (std::size_t k = 0; k < legs.size(); ++k) {
    if (k % kLegsBetweenPolls == 0 && stop.met()) break;
    const Leg& leg = legs[k];
    const auto nearest = field.nearest(leg.from, leg.to, reach);
    if (!nearest) continue;
    const double fraction = nearest->point.fraction;
    const double t = fraction > 0.0 ? leg.t_begin + fraction * (leg.t_end - leg.t_begin) : leg.t_begin;
    const Position where = leg.from + fraction * (leg.to - leg.from);
    return ExecutedCollision{robot, std::nullopt, t, where, radius - nearest->point.distance};
  }
  return std::nullopt;
}

std::optional<ExecutionCollisions> find_collisions(const std::vector<std::vector<Leg>>& legs,
                                                   const std::vector<double>& radii, double tolerance,
                                                   const ObstacleField& field,
                                                   const std::vector<std::size_t>& near_walls,
                                                   const StopCondition& stop) {
  const std::vector<double> tolerances(radii.size(), tolerance);
  const auto clearance = fleet_clearance(legs, {radii, radii}, tolerances, kMostOverlaps, stop);
  if (!clearance) return std::nullopt;
  ExecutionCollisions found;
  const auto consider = [&](const ExecutedCollision& collision) {
    if (!found.first || is_earlier(collision, *found.first)) found.first = collision;
  };
  for (const Overlap& overlap : clearance->overlaps) {  // at most kMostOverlaps
    found.pairs.emplace_back(overlap.first, overlap.second);
    const double t = overlap.t_begin;
    const Position a = position_of(legs[overlap.first], t);
    const Position b = position_of(legs[overlap.second], t);
    const double depth = radii[overlap.first] + radii[overlap.second] - overlap.distance;
    consider({overlap.first, overlap.second, t, Position(0.5 * (a + b)), depth});
  }
  std::sort(found.pairs.begin(), found.pairs.end());
  found.pairs.erase(std::unique(found.pairs.begin(), found.pairs.end()), found.pairs.end());
  for (const std::size_t robot : near_walls) {
    const auto wall = find_wall(field, robot, legs[robot], radii[robot], tolerance, stop);
    if (wall) consider(*wall);
  }
  if (stop.met()) return std::nullopt;
  return found;
}

}  // namespace fleetplan::core
