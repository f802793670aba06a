#pragma once

// Robots whose radius does not change, for reservations.

#include <vector>

#include "core/geometry/segment.h"

namespace fleetplan::core {

inline std::vector<LargestDisk> disks_of(const std::vector<double>& radii, double inflation = 0.0) {
  std::vector<LargestDisk> disks;
  for (const double radius : radii) disks.push_back({radius, radius + inflation});
  return disks;
}

inline std::vector<SizedSegment> sized(const std::vector<TimedSegment>& segments, double radius) {
  std::vector<SizedSegment> all;
  for (const TimedSegment& segment : segments) all.push_back({segment, radius});
  return all;
}

}  // namespace fleetplan::core
