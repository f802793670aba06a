#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>

#include "core/geometry/angle.h"
#include "core/geometry/segment.h"
#include "core/geometry/tolerance.h"
#include "core/instance/motion.h"
#include "core/model/drive_zones.h"
#include "core/reservation/reservation_table.h"

namespace fleetplan::core {

/// The state of a robot at the source of a move.
struct MoveSource {
  double arrival = 0.0;  // seconds
  double heading = 0.0;
  bool by_translation = false;  // it arrived by a translation along `heading`, or
  bool reverse = false;         // backwards
  SafeInterval interval;        // during which it may stand there
};

/// A straight move from a source, into any safe interval of its target.
struct Move {
  double heading = 0.0;             // of the robot
  double duration = 0.0;            // seconds, > 0
  double ready = 0.0;               // earliest departure after the rotation and the added wait
  double latest = 0.0;              // latest departure: the end of the source's safe interval
  bool reverse = false;             // backwards
  bool continues_straight = false;  // without added wait, from `arrival` on; see EdgeTiming
  double arrival = kForever;        // of the robot at the source
};

/// Departures of one robot's moves (paper, "Estimating the feasibility of the move w.r.t. dynamic obstacles
/// and computing earliest arrival time" and "Handling rotations"). A move departs after the rotation and the
/// added wait, within the source's safe interval, arrives within the target's, and collides with no robot on
/// the way. A move in the direction of the translation before it may depart at once: then both form one
/// translation, which has one added wait.
class EdgeTiming {
 public:
  /// `zones` limit the speeds; null if there are none.
  EdgeTiming(const Motion& motion, const ReservationTable& table, std::size_t robot,
             const DriveZones* zones = nullptr)
      : motion_(motion), table_(table), robot_(robot), zones_(zones) {}

  /// The move by `distance` metres (> 0) along `direction`, for which a robot that reverses has the opposite
  /// heading.
  Move move(const MoveSource& from, double direction, double distance, bool reverse = false) const {
    Move move;
    move.heading = reverse ? opposite_heading(direction) : direction;
    move.reverse = reverse;
    move.duration = motion_.translation_time(distance);
    move.ready = from.arrival + motion_.rotation_time(from.heading, move.heading) + motion_.wait_before_move;
    move.latest = from.interval.end;
    move.continues_straight = from.by_translation && from.reverse == reverse &&
                              motion_.wait_before_move > 0.0 &&
                              angle_between(from.heading, move.heading) <= kSameHeading;
    move.arrival = from.arrival;
    return move;
  }

  /// A lower bound of the departure, without regard to robots on the way; kForever if the move is impossible.
  static double lower_bound(const Move& move, const SafeInterval& target) {
    const double latest = std::min(move.latest, target.end - move.duration);
    if (may_continue(move, target, latest)) return move.arrival;
    const double begin = std::max(move.ready, target.begin - move.duration);
    return begin <= latest ? begin : kForever;
  }

  /// The earliest departure along `path`, if there is one. `narrower`: see TimedSegment.
  std::optional<double> earliest(const Move& move, const Segment& path, const SafeInterval& target,
                                 double narrower = 0.0) const;

 private:
  static bool may_continue(const Move& move, const SafeInterval& target, double latest) {
    return move.continues_straight && move.arrival + move.duration >= target.begin && move.arrival <= latest;
  }

  std::optional<double> departure(const Segment& path, double duration, double t_min, double t_max,
                                  double narrower) const;

  const Motion& motion_;
  const ReservationTable& table_;
  std::size_t robot_;
  const DriveZones* zones_;
};

}  // namespace fleetplan::core
