#pragma once

#include <algorithm>
#include <vector>

#include "core/geometry/disk_motion.h"
#include "core/geometry/tolerance.h"
#include "core/reservation/fixed_reservations.h"

namespace fleetplan::core {

/// The obstacles that these segments of `robot` meet, ascending.
inline std::vector<std::size_t> obstacles_hit(const FixedReservations& fixed, std::size_t robot,
                                              const std::vector<SizedSegment>& segments) {
  std::vector<std::size_t> hit;
  for (const SizedSegment& segment : segments) {
    const MovingDisk mine(segment);
    fixed.visit(robot, mine, fixed.robot(robot).disk.pair_radius, 0.0,
                [&](const FixedReservations::Occupant& other) {
                  const double reach = segment.radius + other.radius - kSearchSlack;
                  if (other.is_obstacle && collide(mine, other.disk, reach)) hit.push_back(other.index);
                  return true;
                });
  }
  std::sort(hit.begin(), hit.end());
  hit.erase(std::unique(hit.begin(), hit.end()), hit.end());
  return hit;
}

}  // namespace fleetplan::core
