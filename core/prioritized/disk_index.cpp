#include "core/prioritized/disk_index.h"

#include <algorithm>
#include <cmath>

#include "core/geometry/tolerance.h"

namespace fleetplan::core {

DiskIndex::DiskIndex(const Instance& instance, At at) : instance_(instance), at_(at), size_(0.0) {
  for (std::size_t i = 0; i < instance.size(); ++i) {
    size_ = std::max(size_, 2.0 * instance.largest_pair_radius(i));
  }
}

double DiskIndex::radius(std::size_t robot, At at) const {
  const std::size_t stage = at == At::start ? 0 : instance_.itinerary(robot).goals.size();
  return instance_.motion(robot, stage).pair_radius;
}

std::int64_t DiskIndex::bucket(double coordinate) const {
  return static_cast<std::int64_t>(std::floor(coordinate / size_));
}

std::uint64_t DiskIndex::key(std::int64_t column, std::int64_t row) {
  return (static_cast<std::uint64_t>(column) << 32) ^ static_cast<std::uint64_t>(row);
}

void DiskIndex::add(std::size_t robot, const Position& center) {
  buckets_[key(bucket(center.x()), bucket(center.y()))].push_back({robot, center});
}

std::vector<std::size_t> DiskIndex::overlapping(std::size_t robot, At at, const Position& center) const {
  std::vector<std::size_t> found;
  const double mine = radius(robot, at);
  // Bounded: the robots, each at most once.
  for (std::int64_t column = bucket(center.x()) - 1; column <= bucket(center.x()) + 1; ++column) {
    for (std::int64_t row = bucket(center.y()) - 1; row <= bucket(center.y()) + 1; ++row) {
      const auto disks = buckets_.find(key(column, row));
      if (disks == buckets_.end()) continue;
      for (const Disk& disk : disks->second) {
        const double reach = mine + radius(disk.robot, at_) - kContactTolerance;
        const bool overlap = (disk.center - center).squaredNorm() < reach * reach;
        if (overlap && disk.robot != robot) found.push_back(disk.robot);
      }
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace fleetplan::core
