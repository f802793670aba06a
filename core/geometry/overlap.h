#pragma once

#include <optional>

#include "core/geometry/disk_motion.h"

namespace fleetplan::core {

/// When two disks are nearer to each other than they may be, seconds; begin <= end.
struct OverlapTime {
  double begin = 0.0;
  double end = 0.0;
};

/// The time during which `a` and `b` are closer than `reach` while both last; none if they never are. Unlike
/// for a search, a common instant counts: a disk that is there for one instant only may overlap another one.
std::optional<OverlapTime> overlap(const MovingDisk& a, const MovingDisk& b, double reach);

/// The least distance of the centres while both last; kForever if they have no common time.
double least_distance(const MovingDisk& a, const MovingDisk& b);

}  // namespace fleetplan::core
