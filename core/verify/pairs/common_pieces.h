#pragma once

// Two bodies leg by leg, in the times at which both are present.

#include <algorithm>
#include <span>
#include <vector>

#include "core/verify/execution/execution.h"
#include "core/verify/geometry/relative_motion.h"

namespace fleetplan::core {

/// The first leg that does not end before `t`.
inline std::vector<Leg>::const_iterator first_leg_until(const std::vector<Leg>& legs, double t) {
  return std::lower_bound(legs.begin(), legs.end(), t,
                          [](const Leg& leg, double time) { return leg.t_end < time; });
}

/// Calls `visit(const RelativeMotion&)` for each piece of time within the closed span in which both bodies
/// move straight, in order of time, until it returns false. The motion is that of `b` relative to `a`. Legs
/// of `b` that take no time count only if `counts_instants`.
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
                                  position_at(*j, end) - position_at(*i, end)};
      if (!visit(motion)) return;
    }
    if (i->t_end <= j->t_end) {
      ++i;
    } else {
      ++j;
    }
  }
}

/// The same for all legs of two bodies. A leg that takes no time counts if it is all there is of `b`.
template <typename Visit>
void visit_common_pieces(const std::vector<Leg>& a, const std::vector<Leg>& b, const TimeSpan& span,
                         Visit visit) {
  const auto present = [&span](const std::vector<Leg>& legs) {
    return std::span<const Leg>(first_leg_until(legs, span.begin), legs.end());
  };
  visit_common_pieces(present(a), present(b), span, b.size() == 1, visit);
}

}  // namespace fleetplan::core
