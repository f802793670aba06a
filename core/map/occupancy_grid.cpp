#include "core/map/occupancy_grid.h"

#include <cmath>
#include <cstring>
#include <functional>

namespace fleetplan::core {

OccupancyGrid::OccupancyGrid(int columns, int rows, double resolution)
    : columns_(columns),
      rows_(rows),
      resolution_(resolution),
      blocked_(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows), 0) {}

std::size_t OccupancyGrid::hash() const {
  constexpr std::uint64_t kOdd = 0x9e3779b97f4a7c15;  // 2^64 over the golden ratio
  std::uint64_t hash = std::hash<double>{}(resolution_) + static_cast<std::uint64_t>(columns_);
  const auto mix = [&](std::uint64_t word) {
    hash = (hash ^ word) * kOdd;
    hash ^= hash >> 32U;
  };
  std::size_t at = 0;
  for (std::uint64_t word = 0; at + sizeof word <= blocked_.size(); at += sizeof word) {
    std::memcpy(&word, blocked_.data() + at, sizeof word);
    mix(word);
  }
  for (; at < blocked_.size(); ++at) mix(blocked_[at]);
  return hash;
}

Cell OccupancyGrid::cell_at(const Position& position) const {
  return {static_cast<int>(std::floor(position.x() / resolution_)),
          static_cast<int>(std::floor(position.y() / resolution_))};
}

}  // namespace fleetplan::core
