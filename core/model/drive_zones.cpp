#include "core/model/drive_zones.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/geometry/elementary_functions.h"
#include "core/geometry/position.h"
#include "core/geometry/tolerance.h"

namespace fleetplan::core {
namespace {

/// The length, in metres, below which a piece is joined with a neighbour, at the lower one of their speeds.
constexpr double kShortestPiece = 1e-6;

/// A piece of a move with one speed; it begins where the one before ends.
struct UntimedPiece {
  double last;  // a fraction of the move
  double speed;
};

/// Returns the pieces after neighbours of one speed, and pieces that are too short, have been joined.
std::vector<UntimedPiece> joined(const std::vector<UntimedPiece>& pieces, double length) {
  std::vector<UntimedPiece> result;
  double first = 0.0;  // begin of the last piece in the result
  for (const UntimedPiece& piece : pieces) {
    if (result.empty()) {
      result.push_back(piece);
      continue;
    }
    UntimedPiece& before = result.back();
    const bool is_short = std::min(before.last - first, piece.last - before.last) * length < kShortestPiece;
    if (is_short || before.speed == piece.speed) {
      before = {piece.last, std::min(before.speed, piece.speed)};
    } else {
      first = before.last;
      result.push_back(piece);
    }
  }
  return result;
}

/// Returns the profiles of the pieces of a move of this length; none without inertia.
std::vector<SpeedProfile> profiles_of(const std::vector<UntimedPiece>& pieces, double length,
                                      const Inertia& inertia) {
  if (!inertia.is_limited) return {};
  std::vector<LimitedPart> limited;
  limited.reserve(pieces.size());
  double first = 0.0;
  for (const UntimedPiece& piece : pieces) {
    limited.push_back({(piece.last - first) * length, piece.speed});
    first = piece.last;
  }
  return fastest_profiles(limited, inertia);
}

/// Returns the pieces of the segment from `from` to `to` with their times.
std::vector<DriveZones::Piece> timed(const std::vector<UntimedPiece>& untimed, const Position& from,
                                     const Position& to, const Inertia& inertia) {
  const double length = (to - from).norm();
  const std::vector<SpeedProfile> profiles = profiles_of(untimed, length, inertia);
  std::vector<DriveZones::Piece> pieces;
  Position here = from;
  double first = 0.0;
  double seconds = 0.0;
  for (const UntimedPiece& piece : untimed) {
    const Position next = piece.last < 1.0 ? Position(from + piece.last * (to - from)) : to;
    double end = seconds + (piece.last - first) * length / piece.speed;
    if (!profiles.empty()) end = seconds + duration(profiles[pieces.size()], (piece.last - first) * length);
    pieces.push_back({{here, next}, piece.speed, seconds, end});
    if (!profiles.empty()) pieces.back().profile = profiles[pieces.size() - 1];
    here = next;
    first = piece.last;
    seconds = end;
  }
  return pieces;
}

}  // namespace

DriveZones::DriveZones(const std::vector<Zone>& zones, std::size_t index, const Robot& robot,
                       const Load& load)
    : angular_speed_(robot.angular_speed) {
  std::vector<Area> areas;
  std::vector<OneWayZone> one_way;
  for (std::size_t k = 0; k < zones.size(); ++k) {
    const Zone& zone = zones[k];
    if (!zone.is_for(index)) continue;
    if (zone.type == Zone::Type::one_way) {
      one_way.push_back({k, Polygon(zone.polygon), zone.heading, zone.half_angle});
    } else if (zone.type == Zone::Type::speed) {
      Area& area = areas.emplace_back(Area{k, Polygon(zone.polygon), {}});
      area.limits.linear_speed = zone.linear_speed;
      area.limits.linear_speed_share = zone.linear_speed_share;
      area.limits.angular_speed = zone.angular_speed;
    }
  }
  areas_ = std::make_shared<const std::vector<Area>>(std::move(areas));
  one_way_ = std::make_shared<const std::vector<OneWayZone>>(std::move(one_way));
  take(load);
}

DriveZones DriveZones::with(const Load& load) const {
  DriveZones same = *this;
  same.take(load);
  return same;
}

void DriveZones::take(const Load& load) {
  linear_speed_ = load.linear_speed;
  linear_inertia_ = load.linear_inertia();
  least_angular_speed_ = angular_speed_;
  speed_.clear();
  for (const Area& area : *areas_) {
    const double linear_speed = area.limits.linear_speed_for(load.linear_speed);
    const double angular_speed = area.limits.angular_speed;
    if (linear_speed >= linear_speed_ && angular_speed >= angular_speed_) continue;
    speed_.push_back({&area, linear_speed, angular_speed});
    least_angular_speed_ = std::min(least_angular_speed_, angular_speed);
  }
}

std::optional<std::size_t> DriveZones::forbidding_zone(const Position& from, const Position& to) const {
  const Position way = to - from;
  for (const OneWayZone& zone : *one_way_) {
    if (!zone.polygon.box_meets(from, to)) continue;
    const double direction = heading_of(way);
    if (angle_between(normalize_angle(direction), zone.heading) <= zone.half_angle + kSameHeading) continue;
    if (!zone.polygon.spans_inside(from, to).empty()) return zone.index;
  }
  return std::nullopt;
}

std::optional<std::size_t> DriveZones::broken_by(const Action& action) const {
  const Position& from = action.from.position;
  const Position& to = action.to.position;
  const double duration = action.t_end - action.t_start;
  if (action.type == Action::Type::rotate) {
    const double turn = angle_between(action.from.theta, action.to.theta);
    for (const SpeedZone& zone : speed_) {
      const bool is_fast = action.profile ? action.profile->cruise > zone.angular_speed + kContactTolerance
                                          : duration * zone.angular_speed < turn - kContactTolerance;
      if (is_fast && zone.area->polygon.contains(from) &&
          zone.area->polygon.distance_to_border(from) > kContactTolerance) {
        return zone.area->index;
      }
    }
  }
  if (action.type != Action::Type::translate || from == to) return std::nullopt;
  const double length = (to - from).norm();
  // Bounded: the sides of all zones, each once.
  for (const SpeedZone& zone : speed_) {
    for (const Polygon::Span& span : zone.area->polygon.spans_inside(from, to)) {
      if (action.profile) {
        const double first = span.first * length + kContactTolerance;
        const double last = span.last * length - kContactTolerance;
        const bool is_fast = last > first && fastest_between(*action.profile, first, last, length) >
                                                 zone.linear_speed + kContactTolerance;
        if (is_fast) return zone.area->index;
        continue;
      }
      const double share = span.last - span.first;
      if (share * duration * zone.linear_speed < share * length - kContactTolerance) return zone.area->index;
    }
  }
  return length > kContactTolerance ? forbidding_zone(from, to) : std::nullopt;
}

std::vector<DriveZones::Piece> DriveZones::pieces(const Position& from, const Position& to) const {
  struct Slow {
    Polygon::Span span;
    double speed;
  };
  std::vector<Slow> slow;
  std::vector<double> ends{1.0};
  // Bounded: the sides of all zones, each once.
  for (const SpeedZone& zone : speed_) {
    if (zone.linear_speed >= linear_speed_) continue;
    for (const Polygon::Span& span : zone.area->polygon.spans_inside(from, to)) {
      slow.push_back({span, zone.linear_speed});
      if (span.first > 0.0) ends.push_back(span.first);
      if (span.last < 1.0) ends.push_back(span.last);
    }
  }
  std::sort(ends.begin(), ends.end());
  ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
  std::sort(slow.begin(), slow.end(),
            [](const Slow& a, const Slow& b) { return a.span.first < b.span.first; });
  const auto is_faster = [](const Slow& a, const Slow& b) { return a.speed > b.speed; };
  std::vector<Slow> entered;  // a heap, the slowest at its front
  auto next = slow.begin();
  std::vector<UntimedPiece> untimed;
  double first = 0.0;
  // Bounded: each span is entered and left once.
  for (const double last : ends) {
    const double middle = 0.5 * (first + last);
    UntimedPiece piece{last, linear_speed_};
    for (; next != slow.end() && next->span.first <= middle; ++next) {
      entered.push_back(*next);
      std::push_heap(entered.begin(), entered.end(), is_faster);
    }
    while (!entered.empty() && entered.front().span.last < middle) {
      std::pop_heap(entered.begin(), entered.end(), is_faster);
      entered.pop_back();
    }
    if (!entered.empty()) piece.speed = std::min(piece.speed, entered.front().speed);
    untimed.push_back(piece);
    first = last;
  }
  return timed(joined(untimed, (to - from).norm()), from, to, linear_inertia_);
}

double DriveZones::translation_time(const Position& from, const Position& to) const {
  if (!meets_speed_zone(from, to)) return linear_inertia_.time((to - from).norm(), linear_speed_);
  return pieces(from, to).back().end;
}

bool DriveZones::meets_speed_zone(const Position& from, const Position& to) const {
  return std::any_of(speed_.begin(), speed_.end(),
                     [&](const SpeedZone& zone) { return zone.area->polygon.box_meets(from, to); });
}

DriveZones::Speeds DriveZones::speeds_at(const Position& position) const {
  Speeds least{linear_speed_, angular_speed_};
  for (const SpeedZone& zone : speed_) {
    if (!zone.area->polygon.box_meets(position, position) || !zone.area->polygon.contains(position) ||
        zone.area->polygon.distance_to_border(position) <= kSamePosition) {
      continue;
    }
    least = {std::min(least.linear, zone.linear_speed), std::min(least.angular, zone.angular_speed)};
  }
  return least;
}

double DriveZones::linear_speed_at(const Position& position) const { return speeds_at(position).linear; }

double DriveZones::angular_speed_at(const Position& position) const { return speeds_at(position).angular; }

}  // namespace fleetplan::core
