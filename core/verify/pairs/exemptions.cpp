#include "core/verify/pairs/exemptions.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/verify/check_rules.h"

namespace fleetplan::core {
namespace {

/// How much earlier than an overlap by more than a tolerance an unavoidable collision may begin, in metres:
/// it may begin when the disks touch.
constexpr double kTouching = 2.0 * kMostTolerance;

/// Rounding of the time of an unavoidable collision that went through decimal text, seconds.
constexpr double kTextRounding = 1e-6;

/// Returns the positions of the robot at `t`, ascending; two where its radius changes then.
std::vector<std::size_t> positions_at(const ExecutedFleet& fleet, std::size_t robot, double t) {
  std::vector<std::size_t> positions;
  const auto found = std::lower_bound(fleet.robots.begin(), fleet.robots.end(), robot);
  auto position = static_cast<std::size_t>(found - fleet.robots.begin());
  for (; position < fleet.size() && fleet.robots[position] == robot; ++position) {
    const bool has_begun = fleet.begin_of(position) <= t + kTextRounding;
    if (has_begun && fleet.end_of(position) >= t - kTextRounding) positions.push_back(position);
  }
  return positions;
}

/// Whether an overlap until `t` goes on at the next position of the same robot.
bool goes_on(const ExecutedFleet& fleet, std::size_t position, double t) {
  return t >= fleet.end_of(position) && position + 1 < fleet.size() &&
         fleet.same_robot(position, position + 1);
}

}  // namespace

Exemptions::Exemptions(const std::vector<UnavoidableCollision>& collisions, const ExecutedFleet& fleet,
                       double inflation, const std::vector<std::vector<Leg>>& obstacles,
                       const std::vector<double>& obstacle_radii, const StopCondition& stop)
    : fleet_(fleet),
      inflation_(inflation),
      obstacles_(obstacles),
      obstacle_radii_(obstacle_radii),
      robots_(fleet.size()) {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < fleet.size(); ++i) {
    certain_.push_back({fleet.stays[i] ? kNever : fleet.departures[i].committed_until, kNever});
  }
  std::vector<std::size_t> listed(fleet.size(), 0);
  for (const UnavoidableCollision& collision : collisions) {
    if (stop.met()) return;
    const std::vector<std::size_t> ones = positions_at(fleet, collision.robot, collision.t);
    if (ones.empty() || !is_certain(ones.front(), collision.t)) continue;
    count(ones.front(), collision.t, listed);
    for (const std::size_t one : ones) {
      if (collision.obstacle && *collision.obstacle < obstacles.size()) {
        add_obstacle(one, *collision.obstacle, std::max(collision.t, fleet.begin_of(one)));
      }
      if (collision.other && *collision.other != collision.robot)
        add_pair(one, *collision.other, collision.t);
    }
  }
}

void Exemptions::add_pair(std::size_t one, std::size_t other_robot, double t) {
  for (const std::size_t other : positions_at(fleet_, other_robot, t)) {
    if (!is_certain(other, t)) continue;
    add_robots(one, other, std::max({t, fleet_.begin_of(one), fleet_.begin_of(other)}));
  }
}

void Exemptions::add_obstacle(std::size_t position, std::size_t obstacle, double t) {
  for (;; ++position) {
    const double near = fleet_.radii[position] + obstacle_radii_[obstacle] + kTouching;
    const auto span = time_together(fleet_.legs[position], obstacles_[obstacle], near, t);
    if (!span) return;
    with_obstacles_[obstacle * robots_ + position].push_back(*span);
    if (!goes_on(fleet_, position, span->end)) return;
    t = span->end;
  }
}

void Exemptions::add_robots(std::size_t one, std::size_t other, double t) {
  while (true) {
    const double near = fleet_.kept_distance(one, other, inflation_) + kTouching;
    const auto span = time_together(fleet_.legs[one], fleet_.legs[other], near, t);
    if (!span) return;
    of_robots_[key(one, other)].push_back(*span);
    t = span->end;
    const bool one_goes_on = goes_on(fleet_, one, t);
    const bool other_goes_on = goes_on(fleet_, other, t);
    if (!one_goes_on && !other_goes_on) return;
    one += one_goes_on ? 1 : 0;
    other += other_goes_on ? 1 : 0;
  }
}

bool Exemptions::is_certain(std::size_t position, double t) const {
  return t <= certain_[position].until + kTextRounding;
}

void Exemptions::count(std::size_t position, double t, std::vector<std::size_t>& collisions) {
  std::size_t first = position;
  while (first > 0 && fleet_.same_robot(first - 1, position)) --first;
  if (++collisions[first] < kMostUnavoidableOfRobot) return;
  double& from = certain_[first].exempt_from;
  from = std::isinf(from) ? t : std::max(from, t);
  for (std::size_t next = first + 1; next < fleet_.size() && fleet_.same_robot(first, next); ++next) {
    certain_[next].exempt_from = from;
  }
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
