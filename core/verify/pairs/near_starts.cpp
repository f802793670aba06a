#include "core/verify/pairs/near_starts.h"

#include <algorithm>
#include <limits>
#include <vector>

#include "core/geometry/tolerance.h"
#include "core/verify/pairs/common_pieces.h"
#include "core/verify/pairs/pair_distance.h"

namespace fleetplan::core {
namespace {

/// The legs until the commitment ends, where the robot then stays.
std::vector<Leg> committed_legs(const std::vector<Leg>& legs, double until) {
  std::vector<Leg> kept;
  for (const Leg& leg : legs) {
    if (leg.t_begin >= until && !kept.empty()) break;
    kept.push_back(leg);
  }
  if (kept.back().t_end < until) return kept;  // then it has another radius
  Leg& last = kept.back();
  const Position end = position_at(last, until);
  last = {last.t_begin, until, last.from, end};
  kept.push_back({until, std::numeric_limits<double>::infinity(), end, end});
  return kept;
}

/// Of bodies that both begin before `until`, or then: a robot that grows where its commitment ends.
double least_of_commitments(const ExecutedFleet& fleet, const Overlap& overlap, double until) {
  const auto& a = fleet.legs[overlap.first];
  const auto& b = fleet.legs[overlap.second];
  const double begin = std::max(a.front().t_begin, b.front().t_begin);
  if (until <= begin) {
    const Position apart =
        position_at(*first_leg_until(a, begin), begin) - position_at(*first_leg_until(b, begin), begin);
    return apart.norm();
  }
  return least_distance(committed_legs(a, fleet.departures[overlap.first].committed_until),
                        committed_legs(b, fleet.departures[overlap.second].committed_until), {0.0, until});
}

}  // namespace

std::optional<double> leaves_overlap(const ExecutedFleet& fleet, const Overlap& overlap,
                                     const CheckRules& rules) {
  const Departure& a = fleet.departures[overlap.first];
  const Departure& b = fleet.departures[overlap.second];
  const double bare = fleet.radii[overlap.first] + fleet.radii[overlap.second];
  const double kept = fleet.kept_distance(overlap.first, overlap.second, rules.inflation);
  if (kept <= bare && rules.start_overlap <= 0.0) return std::nullopt;
  // One that has got another radius since its plan began has no right to be so near.
  if (fleet.begin_of(overlap.first) > a.committed_until + kSameTime ||
      fleet.begin_of(overlap.second) > b.committed_until + kSameTime)
    return std::nullopt;
  const double tolerance = std::max(fleet.tolerances[overlap.first], fleet.tolerances[overlap.second]);
  const double moved = std::min(a.first_move_ends, b.first_move_ends);
  const double until = std::max(overlap.t_end, moved);
  if (overlap.distance < bare - tolerance) {
    const double inflated = bare + 2.0 * rules.inflation;
    const double at_start =
        (fleet.legs[overlap.first].front().from - fleet.legs[overlap.second].front().from).norm();
    const bool allowed = overlap.t_begin <= 0.0 && inflated - at_start <= rules.start_overlap + tolerance;
    return allowed && overlap.distance >= at_start - tolerance ? std::optional(until) : std::nullopt;
  }
  const double certain = std::max(a.committed_until, b.committed_until);
  const bool begins_so = overlap.t_begin <= certain + kSameTime;
  const bool first_moves = overlap.t_begin <= moved && overlap.t_end <= moved;
  if (!begins_so && !first_moves) return std::nullopt;
  const double least = least_of_commitments(fleet, overlap, certain);
  return overlap.distance >= least - tolerance ? std::optional(until) : std::nullopt;
}

}  // namespace fleetplan::core
