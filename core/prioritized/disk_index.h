#pragma once

#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "core/geometry/position.h"
#include "core/instance/instance.h"

namespace fleetplan::core {

/// Disks of robots, inflation and vicinity included, by place: finds those that overlap another one.
class DiskIndex {
 public:
  /// The robots' disks where their plans begin, or where they rest at their last goals.
  enum class At : std::uint8_t { start, goal };
  DiskIndex(const Instance& instance, At at);

  /// One disk for each robot at most.
  void add(std::size_t robot, const Position& center);

  /// The robots but `robot` whose disks overlap the disk that `robot` has `at` this position, ascending.
  /// Contact is no overlap.
  std::vector<std::size_t> overlapping(std::size_t robot, At at, const Position& center) const;

 private:
  struct Disk {
    std::size_t robot;
    Position center;
  };

  std::int64_t bucket(double coordinate) const;
  static std::uint64_t key(std::int64_t column, std::int64_t row);

  double radius(std::size_t robot, At at) const;

  const Instance& instance_;
  const At at_;
  double size_;  // of a bucket, metres; two disks that overlap are in the same or in neighbouring ones
  std::unordered_map<std::uint64_t, std::vector<Disk>> buckets_;
};

}  // namespace fleetplan::core
