#include "core/execution/near_stretches.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/execution/conflict_region.h"

namespace fleetplan::core {

namespace {

constexpr std::size_t kLooksBetweenPolls = 1024;
/// To bound memory on huge maps.
constexpr double kMostBuckets = 2.5e5;

double largest_radius(const std::vector<std::vector<PlannedStretch>>& by_robot) {
  double largest = 0.0;
  // Bounded: each stretch once.
  for (const auto& stretches : by_robot) {
    for (const PlannedStretch& stretch : stretches) largest = std::max(largest, stretch.radius);
  }
  return largest;
}

/// Covers all places of all robots.
BucketGrid grid_of(const std::vector<std::vector<PlannedStretch>>& by_robot, double radius) {
  double width = 0.0;
  double height = 0.0;
  // Bounded: each stretch once.
  for (const auto& stretches : by_robot) {
    for (const PlannedStretch& stretch : stretches) {
      width = std::max(width, stretch.planned.path.to.x());
      height = std::max(height, stretch.planned.path.to.y());
    }
  }
  const double size = std::max(
      {2.0 * radius, std::sqrt(width * height / kMostBuckets), width / kMostBuckets, height / kMostBuckets});
  return {width, height, size};
}

}  // namespace

NearStretches::NearStretches(const std::vector<std::vector<PlannedStretch>>& by_robot)
    : by_robot_(by_robot),
      largest_radius_(largest_radius(by_robot)),
      grid_(grid_of(by_robot, largest_radius_)),
      buckets_(grid_.count()) {}

std::optional<std::vector<NearRobot>> NearStretches::near(std::size_t robot, const StopCondition& stop) {
  std::vector<std::vector<NearPair>> by_other(by_robot_.size());
  for (std::size_t index = 0; index < by_robot_[robot].size(); ++index) {
    if (!find_near(robot, index, by_other, stop)) return std::nullopt;
  }
  std::vector<NearRobot> found;
  for (std::size_t other = 0; other < by_other.size(); ++other) {
    if (!by_other[other].empty()) found.push_back({other, std::move(by_other[other])});
  }
  return found;
}

bool NearStretches::find_near(std::size_t robot, std::size_t stretch,
                              std::vector<std::vector<NearPair>>& by_other, const StopCondition& stop) {
  const PlannedStretch& mine = by_robot_[robot][stretch];
  ++asked_;
  const auto look_into = [&](std::size_t bucket, double, double) {
    if (stops_after(1 + buckets_[bucket].size(), stop)) return;
    for (const std::uint32_t id : buckets_[bucket]) {
      Entry& entry = entries_[id];
      if (entry.asked == asked_) continue;
      entry.asked = asked_;
      const PlannedStretch& other = by_robot_[entry.robot][entry.stretch];
      const NearestShares nearest = nearest_shares(other.planned.path, mine.planned.path);
      if (nearest.distance >= other.radius + mine.radius) continue;
      by_other[entry.robot].push_back(
          {static_cast<std::uint32_t>(entry.stretch), static_cast<std::uint32_t>(stretch)});
    }
  };
  // Only the place matters: as if it took a second.
  grid_.cover(MovingDisk({mine.planned.path, 0.0, 1.0}), mine.radius + largest_radius_, look_into);
  return !stopped_;
}

bool NearStretches::add(std::size_t robot, const StopCondition& stop) {
  for (std::size_t index = 0; index < by_robot_[robot].size(); ++index) {
    const Segment& path = by_robot_[robot][index].planned.path;
    const auto id = static_cast<std::uint32_t>(entries_.size());
    entries_.push_back({robot, index});
    const bool added = grid_.walk(path.from, path.to, [&](std::size_t bucket, double, double) {
      buckets_[bucket].push_back(id);
      return !stops_after(1, stop);
    });
    if (!added) return false;
  }
  return true;
}

bool NearStretches::stops_after(std::size_t looks, const StopCondition& stop) {
  looks_ += looks;
  if (looks_ < kLooksBetweenPolls) return stopped_;
  looks_ = 0;
  return stopped_ = stopped_ || stop.met();
}

}  // namespace fleetplan::core
