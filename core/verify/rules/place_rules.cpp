#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/geometry/elementary_functions.h"
#include "core/geometry/position.h"
#include "core/geometry/tolerance.h"
#include "core/verify/rules/robot_rules.h"

namespace fleetplan::core {
namespace {

constexpr double kNone = std::numeric_limits<double>::infinity();

/// Returns when a leg has covered a fraction of its length.
double time_at(const Leg& leg, double fraction) {
  if (fraction <= 0.0) return leg.t_begin;
  double elapsed = fraction;
  if (leg.bend != Position(0.0, 0.0)) {
    // fraction = elapsed - elapsed (1 - elapsed) ramp
    const double ramp = leg.bend.dot(leg.to - leg.from) / (leg.to - leg.from).squaredNorm();
    const double slope = 1.0 - ramp;
    elapsed = 2.0 * fraction / (slope + std::sqrt(std::max(0.0, slope * slope + 4.0 * ramp * fraction)));
  }
  return leg.t_begin + elapsed * (leg.t_end - leg.t_begin);
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
  return {.kind = Violation::Kind::obstacle_collision,
          .robots = {robot},
          .t = t,
          .distance = distance,
          .required = radius,
          .detail = detail};
}

}  // namespace

double distance_from_walls(const ObstacleField& field, const Position& position, double reach) {
  const auto nearest = field.nearest(position, position, reach);
  return nearest ? nearest->point.distance : reach;
}

namespace {

using DistanceFrom = std::function<double(const Position&, double)>;

/// What a robot keeps from obstacles in its legs, metres, where it neither leaves nor enters an overlap.
std::vector<double> full_distances(const std::vector<double>& radii, const std::vector<Leg>& legs,
                                   const Handover& handover, const CheckRules& rules) {
  std::vector<double> full = radii;
  for (std::size_t k = 0; k < legs.size(); ++k) {
    if (!handover.commits(legs[k].t_end)) full[k] += rules.inflation;
  }
  return full;
}

/// Whether a robot goes on in a straight line where a leg ends, so that its move is longer than the leg.
bool goes_on(const std::vector<Leg>& legs, std::size_t k, double tolerance) {
  if (k + 1 >= legs.size()) return false;
  const Position way = legs[k].to - legs[k].from;
  const Position next = legs[k + 1].to - legs[k + 1].from;
  const double longer = std::max(way.norm(), next.norm());
  return way.dot(next) > 0.0 && std::abs(cross_product(way, next)) <= tolerance * longer;
}

/// The distances that a robot keeps from obstacles where it leaves overlaps or enters them, straight from or
/// to where it is clear.
class Overlaps {
 public:
  Overlaps(const DistanceFrom& distance_from, const std::vector<double>& radii, const std::vector<Leg>& legs,
           const Handover& handover, double tolerance, const CheckRules& rules)
      : distance_from_(distance_from),
        radii_(radii),
        legs_(legs),
        tolerance_(tolerance),
        rules_(rules),
        full_(full_distances(radii, legs, handover, rules)),
        kept_(full_) {
    while (planned_ < legs.size() && handover.commits(legs[planned_].t_end)) ++planned_;
  }

  /// A robot that begins too near, or is too near when its commitment ends, comes no nearer until it is
  /// clear.
  void let_leave() {
    double reduced = kNone;  // the distance that it keeps until it has been clear
    for (std::size_t k = 0; k < legs_.size(); ++k) {
      if (k == 0 || k == planned_) {
        const double here = distance_from_(legs_[k].from, full_[k]);
        const double overlap = radii_[k] + rules_.inflation - here;
        const double allowed = k == 0 ? rules_.overlap_at_start() : rules_.goal_overlap;
        const bool may_be_so = overlap <= allowed + tolerance_ || here >= radii_[k] - tolerance_;
        if (here < full_[k] && may_be_so) reduced = std::min(here, reduced);
      }
      kept_[k] = std::min(full_[k], reduced);
      const bool is_straight_on = goes_on(legs_, k, tolerance_);
      if (reduced < full_[k] && !is_straight_on && is_clear(legs_[k].to, k)) reduced = kNone;
    }
  }

  /// A commitment may be on the way into a last goal, or out of one.
  void let_commit() {
    for (std::size_t k = 0; k < planned_; ++k) {
      const double nearest = radii_[k] + rules_.inflation - rules_.goal_overlap;
      kept_[k] = std::min(kept_[k], std::max(nearest, kSmallestDisk * radii_[k]));
    }
  }

  /// A robot that ends nearer to obstacles comes no nearer than that since it was clear.
  void let_enter() {
    const Position& end = legs_.back().to;
    double largest = 0.0;  // the radius with which it is there
    for (std::size_t k = legs_.size(); k-- > 0;) {
      largest = std::max(largest, radii_[k] + rules_.inflation);
      if (!is_same_position(legs_[k].from, end)) break;
    }
    const double here = distance_from_(end, largest);
    if (largest - here > rules_.goal_overlap + tolerance_) return;
    for (std::size_t k = legs_.size(); k-- > 0;) {
      kept_[k] = std::min(kept_[k], here);
      if (k == 0 || goes_on(legs_, k - 1, tolerance_)) continue;
      if (is_clear(legs_[k].from, k) && is_clear(legs_[k].from, k - 1)) break;  // with a load, too
    }
  }

  std::vector<double> kept() && { return std::move(kept_); }

 private:
  bool is_clear(const Position& position, std::size_t leg) const {
    return distance_from_(position, full_[leg]) >= full_[leg] - tolerance_;
  }

  const DistanceFrom& distance_from_;
  const std::vector<double>& radii_;  // by leg, as the following
  const std::vector<Leg>& legs_;
  double tolerance_;  // metres
  const CheckRules& rules_;
  std::vector<double> full_;
  std::vector<double> kept_;
  std::size_t planned_ = 0;  // the first leg after the commitment
};

}  // namespace

std::vector<double> distances_to_keep(const DistanceFrom& distance_from, const std::vector<double>& radii,
                                      const std::vector<Leg>& legs, const Handover& handover,
                                      bool ends_in_goal, double tolerance, const CheckRules& rules) {
  if (rules.inflation <= 0.0 && rules.overlap_at_start() <= 0.0) return radii;
  Overlaps overlaps(distance_from, radii, legs, handover, tolerance, rules);
  overlaps.let_leave();
  if (rules.goal_overlap > 0.0) {
    overlaps.let_commit();
    if (ends_in_goal) overlaps.let_enter();
  }
  return std::move(overlaps).kept();
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
    // Along a wall only rounding makes one moment the deepest; the overlap begins with the leg then.
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

namespace {

/// The speed that stands for an infinite one in a violation.
constexpr double kFastest = 1e30;

Rectangle box_of(const std::vector<Position>& corners) {
  Rectangle box{corners.front(), corners.front()};
  for (const Position& corner : corners) {
    box.low = box.low.cwiseMin(corner);
    box.high = box.high.cwiseMax(corner);
  }
  return box;
}

/// Returns the nearest point of a segment to a zone, if that is nearer than `reach`.
std::optional<NearestPoint> nearest_to_zone(const Position& from, const Position& to, const Zone& zone,
                                            const Rectangle& box, double reach) {
  if (nearest_to_rectangle(from, to, box).distance >= reach) return std::nullopt;
  const NearestPoint nearest = nearest_to_polygon(from, to, zone.polygon);
  return nearest.distance < reach ? std::optional(nearest) : std::nullopt;
}

/// Returns the time at a fraction of a leg; the final rest has no end.
double moment(const Leg& leg, double fraction) {
  return fraction > 0.0 ? leg.t_begin + fraction * (leg.t_end - leg.t_begin) : leg.t_begin;
}

std::string blocked_text(const Zone& zone, double distance, double radius, double t) {
  const std::string where = "blocked zone \"" + zone.id + "\" at t = " + seconds(t);
  return distance > 0.0 ? "the disk reaches " + metres(radius - distance) + " into the " + where
                        : "the centre of the disk reaches the " + where;
}

}  // namespace

ZonesOfRobot::ZonesOfRobot(const std::vector<Zone>* zones, std::size_t index) : robot_(index) {
  if (zones == nullptr) return;
  for (std::size_t k = 0; k < zones->size(); ++k) {
    const Zone& zone = (*zones)[k];
    if (!zone.is_for(index)) continue;
    zones_.push_back({k, &zone, box_of(zone.polygon)});
    may_leave_any_ = may_leave_any_ || zone.may_leave;
  }
}

double ZonesOfRobot::distance_to_blocked(const Position& position, double reach) const {
  double least = reach;
  for (const auto& [index, zone, box] : zones_) {
    if (!zone->is_wall()) continue;
    if (const auto nearest = nearest_to_zone(position, position, *zone, box, least))
      least = nearest->distance;
  }
  return least;
}

/// How far a position is from the zones that the robot may leave.
double ZonesOfRobot::distance_to_leave(const Position& position, double reach) const {
  double least = reach;
  for (const auto& [index, zone, box] : zones_) {
    if (!zone->may_leave) continue;
    if (const auto nearest = nearest_to_zone(position, position, *zone, box, least))
      least = nearest->distance;
  }
  return least;
}

std::optional<std::size_t> ZonesOfRobot::first_goal_put_off(
    const Robot& robot, std::size_t first, double tolerance,
    const std::function<bool(std::size_t)>& visits) const {
  if (!may_leave_any_) return std::nullopt;
  double arrives = robot.radius;
  // Bounded: each goal once, and the corners of the zones, which a request may have.
  for (std::size_t k = 0; k < robot.own_goal_count(); ++k) {
    const double leaves = robot.goal_at(k).radius_after.value_or(arrives);
    const double radius = std::max(arrives, leaves);
    arrives = leaves;
    const double gap = distance_to_leave(robot.goal_at(k).position, radius + tolerance);
    const bool may_be_put_off = k >= first && gap < radius + tolerance;
    if (may_be_put_off && (gap < radius - tolerance || !visits(k))) return k;
  }
  return std::nullopt;
}

/// By leg, whether the robot may be inside of zones that it may leave.
std::vector<bool> ZonesOfRobot::may_be_inside(const std::vector<double>& radii, const std::vector<Leg>& legs,
                                              const Handover& handover, double tolerance,
                                              const StopCondition& stop) const {
  std::vector<bool> may_be(legs.size(), false);
  if (!may_leave_any_) return may_be;
  const auto is_inside = [&](const Position& position, double radius) {
    return distance_to_leave(position, radius - tolerance) < radius - tolerance;
  };
  bool leaves = is_inside(legs.front().from, radii.front());
  for (std::size_t k = 0; k < legs.size() && !stop.met(); ++k) {
    const bool commits = handover.commits(legs[k].t_end);
    may_be[k] = commits || leaves;
    if (commits) leaves = true;  // it may end inside
    if (leaves) leaves = is_inside(legs[k].to, radii[k]);
  }
  return may_be;
}

ViolationList ZonesOfRobot::check_blocked(const std::vector<double>& kept, const std::vector<double>& radii,
                                          const std::vector<Leg>& legs, const Handover& handover,
                                          double tolerance, const StopCondition& stop) const {
  ViolationList violations;
  const std::vector<bool> may_be_inside = this->may_be_inside(radii, legs, handover, tolerance, stop);
  for (const auto& [index, zone, box] : zones_) {
    if (zone->type != Zone::Type::blocked) continue;
    std::optional<Violation> latest;  // the latest violation, which consecutive legs may continue
    for (std::size_t k = 0; k < legs.size(); ++k) {
      if (stop.met()) return violations;
      const Leg& leg = legs[k];
      const bool is_exempt = zone->may_leave && may_be_inside[k];
      const auto nearest =
          is_exempt ? std::nullopt : nearest_to_zone(leg.from, leg.to, *zone, box, kept[k] - tolerance);
      if (!nearest) {
        if (latest) violations.add(*std::exchange(latest, std::nullopt));
        continue;
      }
      if (latest && nearest->distance >= latest->distance - kSamePosition) continue;
      const double t = moment(leg, nearest->fraction);
      latest = Violation{Violation::Kind::zone, {robot_}, t,
                         nearest->distance,     kept[k],  blocked_text(*zone, nearest->distance, kept[k], t)};
      latest->zone = index;
    }
    if (latest) violations.add(std::move(*latest));
  }
  return violations;
}

ViolationList ZonesOfRobot::check_driving(const std::vector<Action>& actions, const CarriedLoads& loads,
                                          const Tolerance& tolerance, const StopCondition& stop) const {
  ViolationList violations;
  for (std::size_t k = 0; k < actions.size(); ++k) {
    for (const ZoneBox& in : zones_) {
      if (stop.met()) return violations;
      const Action& action = actions[k];
      if (in.zone->type == Zone::Type::blocked) continue;
      if (nearest_to_rectangle(action.from.position, action.to.position, in.box).distance > 0.0) continue;
      std::optional<Violation> found;
      if (action.type == Action::Type::translate) {
        const CarriedLoad& load = loads.at(action.t_start);
        found = check_translation(in, action, k, load, tolerance, stop);
      } else if (action.type == Action::Type::rotate) {
        found = check_rotation(in, action, k, tolerance);
      }
      if (found) violations.add(std::move(*found));
    }
  }
  return violations;
}

/// Reports a translation that breaks the rule of a zone. The missing time is measured over the part inside
/// the zone, in the same way as for whole actions.
std::optional<Violation> ZonesOfRobot::check_translation(const ZoneBox& in, const Action& action,
                                                         std::size_t number, const CarriedLoad& load,
                                                         const Tolerance& tolerance,
                                                         const StopCondition& stop) const {
  const Position way = action.to.position - action.from.position;
  const double length = way.norm();
  const double duration = std::max(0.0, action.t_end - action.t_start);
  if (length <= tolerance.metres) return std::nullopt;
  const auto inside =
      stretches_inside(action.from.position, action.to.position, in.zone->polygon, tolerance.metres, stop);
  const std::string name = "actions[" + std::to_string(number) + "]";
  for (const Stretch& stretch : inside) {
    const double t = action.t_start + stretch.first * duration;
    if (in.zone->type == Zone::Type::one_way) {
      const double off = std::abs(rotation_between(in.zone->heading, heading_of(way)));
      if (off <= in.zone->half_angle + tolerance.radians) return std::nullopt;
      return broken(in, t, off, in.zone->half_angle,
                    name + " moves " + radians(off) + " off the heading of the one-way zone \"" +
                        in.zone->id + "\", which allows " + radians(in.zone->half_angle));
    }
    const double share = stretch.last - stretch.first;
    const double limit = in.zone->linear_speed_for(load.linear_speed);
    if (action.profile) {
      // Where it is within the tolerance of the border, it need not be at the limit yet.
      const SpeedProfile& profile = *action.profile;
      const double gained = profile.start * profile.start +
                            2.0 * load.linear_acceleration * (stretch.last * length - tolerance.metres);
      const double to_lose =
          profile.end * profile.end +
          2.0 * load.linear_deceleration * ((1.0 - stretch.first) * length - tolerance.metres);
      const double square = std::min({profile.cruise * profile.cruise, gained, to_lose});
      const double speed = std::sqrt(std::max(0.0, square));
      if (speed <= limit + tolerance.metres) continue;
      return broken(in, t, std::min(speed, kFastest), limit,
                    name + " goes at " + quantity_text(std::min(speed, kFastest), "m/s") +
                        " through the zone \"" + in.zone->id + "\", which allows " +
                        quantity_text(limit, "m/s"));
    }
    const double taken = share * duration;
    const double least = share * length / limit;
    if (taken >= least - tolerance.seconds || taken * limit >= share * length - tolerance.metres) continue;
    const double speed = duration > 0.0 ? length / duration : kFastest;
    return broken(in, t, std::min(speed, kFastest), limit,
                  name + " goes at " + quantity_text(std::min(speed, kFastest), "m/s") +
                      " through the zone \"" + in.zone->id + "\", which allows " +
                      quantity_text(limit, "m/s"));
  }
  return std::nullopt;
}

std::optional<Violation> ZonesOfRobot::check_rotation(const ZoneBox& in, const Action& action,
                                                      std::size_t number, const Tolerance& tolerance) const {
  if (in.zone->type != Zone::Type::speed) return std::nullopt;
  const Position& centre = action.from.position;
  if (!is_deep_inside(in.zone->polygon, centre, tolerance.metres)) return std::nullopt;
  const double turn = std::abs(rotation_between(action.from.theta, action.to.theta));
  const double duration = std::max(0.0, action.t_end - action.t_start);
  const double limit = in.zone->angular_speed;
  if (action.profile && action.profile->cruise > limit + tolerance.radians) {
    return broken(in, action.t_start, std::min(action.profile->cruise, kFastest), limit,
                  "actions[" + std::to_string(number) + "] turns faster than the zone \"" + in.zone->id +
                      "\" allows, which is " + quantity_text(limit, "rad/s"));
  }
  if (duration >= turn / limit - tolerance.seconds || duration * limit >= turn - tolerance.radians) {
    return std::nullopt;
  }
  const double speed = std::min(duration > 0.0 ? turn / duration : kFastest, kFastest);
  return broken(in, action.t_start, speed, limit,
                "actions[" + std::to_string(number) + "] turns at " + quantity_text(speed, "rad/s") +
                    " in the zone \"" + in.zone->id + "\", which allows " + quantity_text(limit, "rad/s"));
}

Violation ZonesOfRobot::broken(const ZoneBox& in, double t, double measured, double required,
                               std::string detail) const {
  Violation violation{Violation::Kind::zone, {robot_}, t, measured, required, std::move(detail)};
  violation.zone = in.index;
  return violation;
}

}  // namespace fleetplan::core
