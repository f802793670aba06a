#pragma once

#include <cstdint>
#include <memory>

#include "core/geometry/position.h"
#include "core/map/blocked_polygons.h"
#include "core/map/occupancy_grid.h"

namespace fleetplan::core {

/// Static feasibility of disks of any radius on the grid (paper, "Estimating the feasibility of the move
/// w.r.t. static obstacles"). Exact, without rasterising per radius: a summed-area table of blocked cells
/// accepts free rectangles at once. Near obstacles the vertical extent of the swept disk in each grid column
/// is computed. A capsule is convex, so its upper boundary is concave, and its maximum over a column is where
/// the capsule is highest, clamped to the column.
class LineOfSight {
 public:
  explicit LineOfSight(const OccupancyGrid& grid);
  /// With polygons that are blocked, too. What is derived from the grid is shared.
  LineOfSight(const LineOfSight& walls, BlockedPolygons polygons);

  /// Returns whether a disk may stand at `center`. Contact with an obstacle (to within kSearchSlack) is
  /// allowed.
  bool disk_fits(const Position& center, double radius) const { return may_sweep(center, center, radius); }

  /// The largest radius of a disk that may stand at `center`, to within 1e-11 m, but at most `most` and at
  /// least `least` (metres), even if that does not fit. Rounding does not keep such a disk from moving away.
  double fitting_radius(const Position& center, double least, double most) const;

  /// Returns whether a disk may sweep the segment, ends included. `radius` > 0 in metres.
  bool may_sweep(const Position& from, const Position& to, double radius) const;

  const BlockedPolygons& polygons() const { return polygons_; }
  /// Returns whether such a sweep is clear of the polygons alone.
  bool clears_polygons(const Position& from, const Position& to, double radius) const;

 private:
  struct Capsule {  // in cells, from.x <= to.x
    Position from;
    Position to;
    double radius;
  };

  bool free_of_cells(const Capsule& capsule) const;
  bool columns_free(const Capsule& capsule) const;
  /// Blocked cells in the rectangle of cells, bounds inclusive and inside the map.
  std::int32_t blocked_in(int column_min, int column_max, int row_min, int row_max) const;

  int columns_;
  int rows_;
  double cells_per_metre_;
  std::shared_ptr<const std::int32_t[]> sums_;  // (columns + 1) x (rows + 1)
  BlockedPolygons polygons_;
};

}  // namespace fleetplan::core
