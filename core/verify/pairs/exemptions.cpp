#include "core/verify/pairs/exemptions.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/model/most_meetings.h"
#include "core/verify/pairs/pair_distance.h"
#include "core/verify/tolerances.h"

namespace fleetplan::core {
namespace {

/// Metres. A meeting may begin when the disks touch, so slightly before they overlap by more than a
/// tolerance.
constexpr double kTouching = 2.0 * kMostTolerance;

/// Seconds. The time of a meeting went through decimal text.
constexpr double kTextRounding = 1e-6;

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
  constexpr double kNever = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < fleet.size(); ++i) {
    certain_.push_back({fleet.stays[i] ? kNever : fleet.departures[i].committed_until, kNever});
  }
  std::vector<std::size_t> listed(fleet.size(), 0);
  for (const Meeting& meeting : meetings) {
    if (stop.met()) return;
    const auto one = position_of(fleet, meeting.robot);
    if (!one || !is_certain(*one, meeting.t)) continue;
    count(*one, meeting.t, listed);
    if (meeting.obstacle && *meeting.obstacle < obstacles.size()) {
      const double near = fleet.radii[*one] + obstacle_radii[*meeting.obstacle] + kTouching;
      const auto span = time_together(fleet.legs[*one], obstacles[*meeting.obstacle], near, meeting.t);
      if (span) with_obstacles_[*meeting.obstacle * robots_ + *one].push_back(*span);
    }
    const auto other = meeting.other ? position_of(fleet, *meeting.other) : std::nullopt;
    if (!other || other == one || !is_certain(*other, meeting.t)) continue;
    const double near = fleet.kept_distance(*one, *other, inflation) + kTouching;
    const auto span = time_together(fleet.legs[*one], fleet.legs[*other], near, meeting.t);
    if (span) of_robots_[key(*one, *other)].push_back(*span);
  }
}

bool Exemptions::is_certain(std::size_t position, double t) const {
  return t <= certain_[position].until + kTextRounding;
}

void Exemptions::count(std::size_t position, double t, std::vector<std::size_t>& meetings) {
  if (++meetings[position] < kMostMeetingsOfRobot) return;
  double& from = certain_[position].exempt_from;
  from = std::isinf(from) ? t : std::max(from, t);
}

bool Exemptions::allow_robots(std::size_t one, std::size_t other, double t) const {
  if (any_contains(of_robots(one, other), t)) return true;
  return t >= std::min(certain_[one].exempt_from, certain_[other].exempt_from) &&
         t <= std::min(certain_[one].until, certain_[other].until);
}

bool Exemptions::allow_obstacle(std::size_t robot, std::size_t obstacle, double t) const {
  if (any_contains(with_obstacle(robot, obstacle), t)) return true;
  return t >= certain_[robot].exempt_from && t <= certain_[robot].until;
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
