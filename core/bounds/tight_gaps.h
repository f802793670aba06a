#pragma once

#include "core/geometry/position.h"
#include "core/map/occupancy_grid.h"

namespace fleetplan::core {

/// Gaps of an even number of cells that a disk fits exactly. Its centre would have to move along a grid line
/// there; a robot that starts, stops and turns on cell centres never does.
class TightGaps {
 public:
  /// `radius` of the robot, metres. If it may stop elsewhere than at centres of cells, no gap is tight.
  TightGaps(const OccupancyGrid& grid, double radius, bool stops_at_cell_centers);

  /// Whether a move of this length from `begin` to `end` (metres) passes through such a gap.
  bool crossed_by(const Position& begin, const Position& end, double length) const;

 private:
  bool is_gap(int line, int cell, bool vertical) const;

  const OccupancyGrid& grid_;
  int width_;  // cells, even; 0 if the disk has no tight gap
};

}  // namespace fleetplan::core
