#pragma once

// Straight moves and rotations as a robot drives them, with its inertia and in speed zones: how long they
// take, and when they can depart.

#include <optional>
#include <vector>

#include "core/geometry/position.h"
#include "core/geometry/segment.h"
#include "core/geometry/speed_profile.h"
#include "core/model/body.h"
#include "core/model/drive_zones.h"
#include "core/model/trajectory.h"
#include "core/reservation/reservation_table.h"

namespace fleetplan::core {

/// How long straight moves and rotations take, by the robot's limits and the zones that limit how it drives.
class MoveTimes {
 public:
  /// `zones`: null if there are none. Both must outlive this object.
  MoveTimes(const Body& body, const DriveZones* zones)
      : body_(body),
        slowest_body_(body),
        zones_(zones != nullptr && zones->limit_speeds() ? zones : nullptr) {
    if (zones_ != nullptr) slowest_body_.angular_speed = zones_->least_angular_speed();
  }

  const Body& body() const { return body_; }
  /// The robot's limits with the least angular speed of all zones.
  const Body& slowest_body() const { return slowest_body_; }
  /// Whether the robot has to drive more slowly in some places.
  bool limit_speeds() const { return zones_ != nullptr; }
  /// Whether the speed may change during a straight move.
  bool have_parts() const { return limit_speeds() || body_.linear_inertia.is_limited; }

  /// Seconds of a straight move of this length, from rest to rest. `path` returns its Segment. It is called
  /// only if there are zones.
  template <class Path>
  double translation_time(double length, const Path& path) const {
    if (!limit_speeds()) return body_.translation_time(length);
    const Segment& segment = path();
    return zones_->translation_time(segment.from, segment.to);
  }
  /// Seconds to turn at a position.
  double rotation_time(const Position& position, double from, double to) const {
    if (!limit_speeds()) return body_.rotation_time(from, to);
    return body_.angular_inertia.time(angle_between(from, to), zones_->angular_speed_at(position));
  }
  /// The greatest linear speed at a position, metres per second.
  double linear_speed(const Position& position) const {
    return limit_speeds() ? zones_->linear_speed_at(position) : body_.linear_speed;
  }

  /// The pieces of a straight move from rest to rest, between the borders of speed zones. In seconds from its
  /// beginning.
  std::vector<DriveZones::Piece> pieces(const Segment& path) const {
    if (limit_speeds()) return zones_->pieces(path.from, path.to);
    DriveZones::Piece piece{path, body_.linear_speed, 0.0, body_.translation_time(path.length())};
    if (body_.linear_inertia.is_limited) {
      piece.profile = fastest_profile(path.length(), body_.linear_speed, body_.linear_inertia);
    }
    return {piece};
  }

 private:
  const Body& body_;
  Body slowest_body_;
  const DriveZones* zones_;  // null if they limit no speeds
};

/// The parts of a straight move from rest to rest in which its acceleration is constant. In seconds from its
/// departure.
std::vector<TimedSegment> parts_of(const std::vector<DriveZones::Piece>& pieces);

/// The earliest departure in [t_min, t_max] of a straight move of `duration` seconds (> 0), see
/// ReservationTable::earliest_departure(). The speed may change on the way.
std::optional<double> earliest_departure(const ReservationTable& table, const Footprint& footprint,
                                         const MoveTimes& times, const Segment& way, double duration,
                                         double t_min, double t_max);

/// A straight move from rest to rest, divided into parts of different speeds. Each part continues the part
/// before.
std::vector<TimedMove> timed_moves(const MoveTimes& times, const Segment& way, double departure,
                                   double arrival, bool reverse);

}  // namespace fleetplan::core
