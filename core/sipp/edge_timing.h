#pragma once

#include <cstddef>
#include <optional>

#include "core/geometry/interval.h"
#include "core/geometry/tolerance.h"
#include "core/instance.h"
#include "core/reservation/reservation_table.h"

namespace fleetplan::core {

/// Where a move starts from.
struct Standing {
  double arrival = 0.0;  // seconds
  double heading = 0.0;
  bool moving = false;    // it arrives by a translation along `heading`
  SafeInterval interval;  // in which it stands there
};

/// A straight move that a robot may make from where it stands, into whichever interval of the place it leads
/// to.
struct Move {
  double heading = 0.0;
  double duration = 0.0;      // seconds, > 0
  double ready = 0.0;         // when the robot has turned and waited
  double latest = 0.0;        // when the source's interval ends
  bool passes_on = false;     // it may depart at `arrival` instead, as it arrives in the move's direction
  double arrival = kForever;  // at the source
};

/// When one robot's moves may depart: after the rotation and the added wait, within the safe intervals of
/// both ends, clear of everybody on the way. A robot that arrives in the direction of its next move may go on
/// without the added wait, as both are one translation then.
class EdgeTiming {
 public:
  EdgeTiming(const Motion& motion, const ReservationTable& table, std::size_t robot)
      : motion_(motion), table_(table), robot_(robot) {}

  /// The move by `distance` metres (> 0) along `heading`.
  Move move(const Standing& from, double heading, double distance) const {
    Move move;
    move.heading = heading;
    move.duration = motion_.translation_time(distance);
    move.ready = from.arrival + motion_.rotation_time(from.heading, heading) + motion_.wait_before_move;
    move.latest = from.interval.end;
    move.passes_on =
        from.moving && motion_.wait_before_move > 0.0 && angle_between(from.heading, heading) <= kSameHeading;
    move.arrival = from.arrival;
    return move;
  }

  /// The earliest departure that rotation, waits and safe intervals allow, without regard to those on the
  /// way; kForever if there is none.
  static double optimistic(const Move& move, const SafeInterval& target) {
    const double latest = std::min(move.latest, target.end - move.duration);
    if (passes_on(move, target, latest)) return move.arrival;
    const double begin = std::max(move.ready, target.begin - move.duration);
    return begin <= latest ? begin : kForever;
  }

  /// The earliest departure along `path`; none if there is none.
  std::optional<double> earliest(const Move& move, const Segment& path, const SafeInterval& target) const;

 private:
  static bool passes_on(const Move& move, const SafeInterval& target, double latest) {
    return move.passes_on && move.arrival + move.duration >= target.begin && move.arrival <= latest;
  }

  const Motion& motion_;
  const ReservationTable& table_;
  std::size_t robot_;
};

}  // namespace fleetplan::core
