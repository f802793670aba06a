#include "core/execution/near_stretches.h"

#include <algorithm>
#include <cmath>

#include "core/execution/conflict_region.h"

namespace fleetplan::core {

namespace {

/// To bound memory on huge maps.
constexpr double kMostBuckets = 2.5e5;

double largest_radius(const std::vector<std::vector<PlannedStretch>>& by_robot) {
  double largest = 0.0;
  for (const auto& stretches : by_robot) {
    for (const PlannedStretch& stretch : stretches) largest = std::max(largest, stretch.radius);
  }
  return largest;
}

/// Covers all places of all robots.
BucketGrid grid_of(const std::vector<std::vector<PlannedStretch>>& by_robot, double radius) {
  double width = 0.0;
  double height = 0.0;
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

std::vector<NearPair> NearStretches::near(std::size_t robot) {
  std::vector<NearPair> pairs;
  for (std::size_t index = 0; index < by_robot_[robot].size(); ++index) {
    const PlannedStretch& mine = by_robot_[robot][index];
    ++asked_;
    // Only the place matters: as if it took a second.
    const MovingDisk swept({mine.planned.path, 0.0, 1.0});
    grid_.cover(swept, mine.radius + largest_radius_, [&](std::size_t bucket, double, double) {
      for (const std::uint32_t id : buckets_[bucket]) {
        Entry& entry = entries_[id];
        if (entry.asked == asked_) continue;
        entry.asked = asked_;
        const PlannedStretch& other = by_robot_[entry.robot][entry.stretch];
        const NearestShares nearest = nearest_shares(other.planned.path, mine.planned.path);
        if (nearest.distance < other.radius + mine.radius) {
          pairs.push_back({entry.robot, entry.stretch, index});
        }
      }
    });
  }
  std::stable_sort(pairs.begin(), pairs.end(),
                   [](const NearPair& a, const NearPair& b) { return a.other < b.other; });
  return pairs;
}

void NearStretches::add(std::size_t robot) {
  for (std::size_t index = 0; index < by_robot_[robot].size(); ++index) {
    const Segment& path = by_robot_[robot][index].planned.path;
    const auto id = static_cast<std::uint32_t>(entries_.size());
    entries_.push_back({robot, index});
    grid_.walk(path.from, path.to, [&](std::size_t bucket, double, double) {
      buckets_[bucket].push_back(id);
      return true;
    });
  }
}

}  // namespace fleetplan::core
