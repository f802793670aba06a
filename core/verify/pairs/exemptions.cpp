#include "core/verify/pairs/exemptions.h"

#include <algorithm>
#include <utility>

#include "core/verify/pairs/pair_distance.h"
#include "core/verify/tolerances.h"

namespace fleetplan::core {
namespace {

/// Metres. A meeting may begin when the disks touch, so slightly before they overlap by more than a
/// tolerance.
constexpr double kTouching = 2.0 * kMostTolerance;

std::optional<std::size_t> position_of(const ExecutedFleet& fleet, std::size_t robot) {
  const auto found = std::lower_bound(fleet.robots.begin(), fleet.robots.end(), robot);
  if (found == fleet.robots.end() || *found != robot) return std::nullopt;
  return static_cast<std::size_t>(found - fleet.robots.begin());
}

}  // namespace

Exemptions::Exemptions(const std::vector<Meeting>& meetings, const ExecutedFleet& fleet, double inflation,
                       const std::vector<std::vector<Leg>>& obstacles,
                       const std::vector<double>& obstacle_radii, const StopCondition& stop)
    : robots_(fleet.size()) {
  for (const Meeting& meeting : meetings) {
    if (stop.met()) return;
    const auto one = position_of(fleet, meeting.robot);
    if (!one) continue;
    if (meeting.obstacle && *meeting.obstacle < obstacles.size()) {
      const double near = fleet.radii[*one] + obstacle_radii[*meeting.obstacle] + kTouching;
      const auto span = time_together(fleet.legs[*one], obstacles[*meeting.obstacle], near, meeting.t);
      if (span) with_obstacles_[*meeting.obstacle * robots_ + *one].push_back(*span);
    }
    const auto other = meeting.other ? position_of(fleet, *meeting.other) : std::nullopt;
    if (!other || other == one) continue;
    const double near = fleet.radii[*one] + fleet.radii[*other] + 2.0 * inflation + kTouching;
    const auto span = time_together(fleet.legs[*one], fleet.legs[*other], near, meeting.t);
    if (span) of_robots_[key(*one, *other)].push_back(*span);
  }
}

const std::vector<TimeSpan>& Exemptions::of_robots(std::size_t one, std::size_t other) const {
  return find(of_robots_, key(one, other));
}

const std::vector<TimeSpan>& Exemptions::with_obstacle(std::size_t robot, std::size_t obstacle) const {
  return find(with_obstacles_, obstacle * robots_ + robot);
}

const std::vector<TimeSpan>& Exemptions::find(const Spans& spans, std::uint64_t pair) {
  static const std::vector<TimeSpan> none;
  const auto found = spans.find(pair);
  return found == spans.end() ? none : found->second;
}

std::uint64_t Exemptions::key(std::size_t one, std::size_t other) const {
  return static_cast<std::uint64_t>(std::min(one, other)) * robots_ + std::max(one, other);
}

bool any_contains(const std::vector<TimeSpan>& spans, double t) {
  return std::any_of(spans.begin(), spans.end(),
                     [t](const TimeSpan& span) { return span.begin <= t && t <= span.end; });
}

}  // namespace fleetplan::core
