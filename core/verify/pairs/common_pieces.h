#pragma once

// Two bodies leg by leg, in the times at which both are present.

#include <algorithm>
#include <vector>

#include "core/verify/execution/execution.h"
#include "core/verify/geometry/relative_motion.h"

namespace fleetplan::core {

/// Calls `visit(const RelativeMotion&)` for each piece of time within the closed span in which both bodies
/// move straight, in order of time, until it returns false. The motion is that of `b` relative to `a`. Legs
/// that take no time count only if they are all there is of `b`.
template <typename Visit>
void visit_common_pieces(const std::vector<Leg>& a, const std::vector<Leg>& b, const TimeSpan& span,
                         Visit visit) {
  const auto first = [&span](const std::vector<Leg>& legs) {
    return std::lower_bound(legs.begin(), legs.end(), span.begin,
                            [](const Leg& leg, double t) { return leg.t_end < t; });
  };
  for (auto i = first(a), j = first(b); i != a.end() && j != b.end();) {
    const double begin = std::max({i->t_begin, j->t_begin, span.begin});
    const double end = std::min({i->t_end, j->t_end, span.end});
    if (begin > span.end) return;
    const bool instant = begin == end && b.size() == 1 && j->t_begin == j->t_end;
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

}  // namespace fleetplan::core
