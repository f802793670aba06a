#include "core/sipp/edge_timing.h"

#include <algorithm>

namespace fleetplan::core {

std::optional<double> EdgeTiming::earliest(const Move& move, const Segment& path,
                                           const SafeInterval& target) const {
  const double latest = std::min(move.latest, target.end - move.duration);
  if (may_continue(move, target, latest)) {
    const auto at_once = table_.earliest_departure(robot_, path, move.duration, move.arrival, move.arrival);
    if (at_once) return at_once;
  }
  const double begin = std::max(move.ready, target.begin - move.duration);
  if (begin > latest) return std::nullopt;
  return table_.earliest_departure(robot_, path, move.duration, begin, latest);
}

}  // namespace fleetplan::core
