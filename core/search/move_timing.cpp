#include "core/search/move_timing.h"

#include <algorithm>

namespace fleetplan::core {

bool MoveTiming::passes_through(const Standing& from, const Move& move) const {
  return from.moving && motion_.wait_before_move > 0.0 &&
         angle_between(from.heading, move.heading) <= kSameHeading &&
         from.arrival + move.duration >= move.target.begin && from.arrival <= latest(from, move);
}

/// When it is turned, has waited, and would not arrive too early.
double MoveTiming::ready(const Standing& from, const Move& move) const {
  const double turned = from.arrival + motion_.rotation_time(from.heading, move.heading);
  return std::max(turned + motion_.wait_before_move, move.target.begin - move.duration);
}

double MoveTiming::latest(const Standing& from, const Move& move) {
  return std::min(from.interval.end, move.target.end - move.duration);
}

std::optional<double> MoveTiming::optimistic(const Standing& from, const Move& move) const {
  if (passes_through(from, move)) return from.arrival;
  const double begin = ready(from, move);
  return begin <= latest(from, move) ? std::optional(begin) : std::nullopt;
}

std::optional<double> MoveTiming::earliest(const Standing& from, const Move& move) const {
  if (passes_through(from, move)) {
    const auto at_once =
        table_.earliest_departure(robot_, move.path, move.duration, from.arrival, from.arrival);
    if (at_once) return at_once;
  }
  const double begin = ready(from, move);
  const double end = latest(from, move);
  if (begin > end) return std::nullopt;
  return table_.earliest_departure(robot_, move.path, move.duration, begin, end);
}

}  // namespace fleetplan::core
