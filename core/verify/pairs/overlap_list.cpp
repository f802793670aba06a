#include "core/verify/pairs/overlap_list.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "core/geometry/tolerance.h"

namespace fleetplan::core {

void OverlapList::add(std::size_t first, std::size_t second, const RelativeMotion& motion, double allowed) {
  const std::optional<TimeSpan> span = span_closer_than(motion, allowed);
  if (!span) return;
  const ClosestMoment closest = closest_moment(motion);
  const std::uint64_t pair = static_cast<std::uint64_t>(first) << 32 | second;
  const auto latest = latest_.find(pair);
  if (latest != latest_.end() && overlaps_[latest->second].t_end >= span->begin) {
    Overlap& overlap = overlaps_[latest->second];
    overlap.t_end = std::max(overlap.t_end, span->end);
    // Disks with equal velocities come nearer only by rounding: that is not a later, deeper moment.
    if (closest.distance < overlap.distance - kSamePosition) overlap.t_deepest = closest.t;
    overlap.distance = std::min(overlap.distance, closest.distance);
  } else if (overlaps_.size() < most_) {
    latest_[pair] = overlaps_.size();
    overlaps_.push_back({first, second, span->begin, span->end, closest.t, closest.distance});
  }
}

std::vector<Overlap> OverlapList::take() { return std::move(overlaps_); }

}  // namespace fleetplan::core
