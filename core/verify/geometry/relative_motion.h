#pragma once

// The motion of a point relative to another point, both straight at constant acceleration. Also two bodies
// leg by leg, at equal and at slightly different times.

#include <algorithm>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "core/geometry/position.h"
#include "core/verify/execution.h"

namespace fleetplan::core {

/// The displacement from one point to another. It is linear in time, or a parabola if it bends (see
/// Leg::bend). If neither point moves, or both have the same velocity, from == to, and t_end may be infinite.
///
/// The squared distance of a parabola is of degree four in time. It is monotone between the roots of its
/// derivative, a cubic. The cubic is monotone between the roots of its own derivative. All roots are
/// bracketed in this way.
struct RelativeMotion {
  double t_begin = 0.0;
  double t_end = 0.0;
  Position from{0.0, 0.0};
  Position to{0.0, 0.0};
  Position bend{0.0, 0.0};

  bool bends() const { return bend != Position(0.0, 0.0); }
};

/// The time and distance of the closest approach. If there are several such times, the first one.
struct ClosestMoment {
  double t = 0.0;
  double distance = 0.0;  // metres
};

struct TimeSpan {
  double begin = 0.0;
  double end = 0.0;
};

/// Returns the least squared distance, m^2. The error of the distance is a few ulp of the larger coordinate.
double least_squared_distance(const RelativeMotion& motion);

/// Returns the moment of least distance, as exact as `least_squared_distance`. If the points come nearer by
/// at most kSamePosition, which may be rounding, it is the beginning.
ClosestMoment closest_moment(const RelativeMotion& motion);

/// Returns the open time span in which the distance is less than `distance`; none if it never is. A parabola
/// may be farther away in between.
///
/// An end of the span at an end of the motion is exact. Inside the motion, its error is a few ulp of the
/// coordinates divided by the speed. Where the approach is tangential, it is the square root of this.
std::optional<TimeSpan> span_closer_than(const RelativeMotion& motion, double distance);

/// Returns the first leg that does not end before `t`.
inline std::vector<Leg>::const_iterator first_leg_until(const std::vector<Leg>& legs, double t) {
  return std::lower_bound(legs.begin(), legs.end(), t,
                          [](const Leg& leg, double time) { return leg.t_end < time; });
}

/// Returns the bend of the part of a leg between two times.
inline Position bend_between(const Leg& leg, double begin, double end) {
  if (leg.bend == Position(0.0, 0.0)) return leg.bend;
  const double share = (end - begin) / (leg.t_end - leg.t_begin);
  return share * share * leg.bend;
}

/// Calls `visit(const RelativeMotion&)` for each piece of time within the closed span in which both bodies
/// move straight. The pieces come in order of time, until it returns false. The motion is relative: `b` as
/// seen from `a`. Legs of `b` that take no time count only if `counts_instants`.
template <typename Visit>
void visit_common_pieces(std::span<const Leg> a, std::span<const Leg> b, const TimeSpan& span,
                         bool counts_instants, Visit visit) {
  for (auto i = a.begin(), j = b.begin(); i != a.end() && j != b.end();) {
    const double begin = std::max({i->t_begin, j->t_begin, span.begin});
    const double end = std::min({i->t_end, j->t_end, span.end});
    if (begin > span.end) return;
    const bool instant = counts_instants && begin == end && j->t_begin == j->t_end;
    if (begin < end || instant) {
      const RelativeMotion motion{begin, end, position_at(*j, begin) - position_at(*i, begin),
                                  position_at(*j, end) - position_at(*i, end),
                                  bend_between(*j, begin, end) - bend_between(*i, begin, end)};
      if (!visit(motion)) return;
    }
    if (i->t_end <= j->t_end) {
      ++i;
    } else {
      ++j;
    }
  }
}

/// Visits the common pieces of all legs of two bodies. A leg that takes no time counts if it is the only leg
/// of `b`.
template <typename Visit>
void visit_common_pieces(const std::vector<Leg>& a, const std::vector<Leg>& b, const TimeSpan& span,
                         Visit visit) {
  const auto present = [&span](const std::vector<Leg>& legs) {
    return std::span<const Leg>(first_leg_until(legs, span.begin), legs.end());
  };
  visit_common_pieces(present(a), present(b), span, b.size() == 1, visit);
}

/// Returns the least distance between the centres of two bodies within a time span, metres. Infinity if they
/// are never there together.
double least_distance(const std::vector<Leg>& a, const std::vector<Leg>& b, const TimeSpan& span);

/// Returns the uninterrupted time around `t` in which two bodies are nearer to each other than `distance`.
/// None if they are not nearer at `t`.
std::optional<TimeSpan> time_together(const std::vector<Leg>& a, const std::vector<Leg>& b, double distance,
                                      double t);

/// The two times at which two bodies are nearest to each other, and their distance then.
struct ShiftedMoment {
  double distance = 0.0;  // metres; infinity if there is no such pair of times
  double t_first = 0.0;
  double t_second = 0.0;
};

/// Returns the least distance between leg `a` at a time within `first` and leg `b` at a time within `second`.
/// The two times may differ by up to `margin`. All times are finite.
///
/// Exact up to rounding for straight legs. For legs that bend, exact up to kSamePosition, or up to a
/// hundredth of `enough` (metres) if the distance is less than `enough`. Otherwise, returns infinity or any
/// other number that is not less than `enough`.
ShiftedMoment least_shifted_distance(const Leg& a, const TimeSpan& first, const Leg& b,
                                     const TimeSpan& second, double margin,
                                     double enough = std::numeric_limits<double>::infinity());

}  // namespace fleetplan::core
