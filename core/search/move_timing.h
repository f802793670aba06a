#pragma once

#include <cstddef>
#include <optional>

#include "core/geometry/interval.h"
#include "core/reservation/reservation_table.h"
#include "core/search/fleet.h"

namespace fleetplan::core {

/// Directions that differ by less are the same (radians): far above rounding, far below a visible bend.
inline constexpr double kSameHeading = 1e-12;

/// Where a move starts from.
struct Standing {
  double arrival = 0.0;  // seconds
  double heading = 0.0;
  bool moving = false;    // it arrives by a translation along `heading`
  SafeInterval interval;  // in which it stands there
};

/// A straight move to make.
struct Move {
  Segment path;
  double heading = 0.0;
  double duration = 0.0;  // seconds, > 0
  SafeInterval target;    // in which it arrives
};

/// When one robot's moves may depart: after the rotation and the added wait, within the safe intervals of
/// both ends, clear of everybody on the way. A robot that arrives in the direction of its next move may go on
/// without the added wait, as both are one translation then.
class MoveTiming {
 public:
  MoveTiming(const Motion& motion, const ReservationTable& table, std::size_t robot)
      : motion_(motion), table_(table), robot_(robot) {}

  /// The earliest departure that rotation, waits and safe intervals allow, without regard to those on the
  /// way; none if there is none.
  std::optional<double> optimistic(const Standing& from, const Move& move) const;

  /// The earliest departure; none if there is none.
  std::optional<double> earliest(const Standing& from, const Move& move) const;

 private:
  bool passes_through(const Standing& from, const Move& move) const;
  double ready(const Standing& from, const Move& move) const;
  static double latest(const Standing& from, const Move& move);

  const Motion& motion_;
  const ReservationTable& table_;
  std::size_t robot_;
};

}  // namespace fleetplan::core
