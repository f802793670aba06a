#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/geometry/polygon.h"
#include "core/geometry/position.h"
#include "core/map/occupancy_grid.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// Where disks of any radius may stand and move on the grid (paper, "Estimating the feasibility of the move
/// w.r.t. static obstacles"). Exact, without rasterising per radius.
///
/// The distance transform bounds the distance of every point from the obstacles, to within about a cell. A
/// move is followed in steps, as long as the bounds prove each step free (sphere tracing; Hart, 1996). This
/// decides most moves. Where the bounds leave it in doubt, the vertical extent of the swept disk in each grid
/// column is computed. For small disks, free rectangles of cells replace the bounds.
///
/// A capsule is convex, so its upper boundary is concave. Its maximum over a column is where the capsule is
/// highest, clamped to the column.
class LineOfSight {
 public:
  /// Derives what the tests need from the grid. If `stop` is met first, the object is not finished() and must
  /// not be used.
  LineOfSight(const OccupancyGrid& grid, const StopCondition& stop);
  /// The line of sight among the walls of `walls` and further polygons. Both objects share what is derived
  /// from the grid.
  LineOfSight(const LineOfSight& walls, BlockedPolygons polygons);

  bool finished() const { return cells_->finished; }

  /// Returns whether a disk may stand at `center`. Contact with an obstacle (to within kSearchSlack) is
  /// allowed.
  bool disk_fits(const Position& center, double radius) const { return may_sweep(center, center, radius); }

  /// Returns the largest radius of a disk that may stand at `center`, to within 1e-11 m. At most `max` and at
  /// least `least` (metres), even if `least` does not fit. Such a disk can move away in spite of rounding.
  double fitting_radius(const Position& center, double least, double max) const;

  /// Returns whether a disk may sweep the segment, ends included. `radius` > 0 in metres.
  bool may_sweep(const Position& from, const Position& to, double radius) const;

  /// Returns a distance that a disk may move from `center` in any direction, metres. The bound is quick to
  /// compute, and within about a cell of the exact distance. Negative if the disk does not fit, or may not
  /// fit.
  double surely_free(const Position& center, double radius) const;
  /// Returns a distance from `center` within which no disk of this radius fits, metres. Negative if the disk
  /// fits, or may fit.
  double surely_blocked(const Position& center, double radius) const;

  const BlockedPolygons& polygons() const { return polygons_; }
  /// Returns whether such a sweep is clear of the polygons, without regard to the walls.
  bool clears_polygons(const Position& from, const Position& to, double radius) const;

  /// The distances from blocked cells.
  const DistanceTransform& distances() const { return cells_->distances; }
  /// The memory of what is derived from the grid.
  std::size_t bytes() const;

 private:
  struct Capsule {  // in cells, from.x <= to.x
    Position from;
    Position to;
    double radius;
  };
  struct Cells {
    Cells(const OccupancyGrid& grid, const StopCondition& stop);

    DistanceTransform distances;
    std::vector<std::uint64_t> blocked;  // a bit for each of 64 rows; by band of rows, then column
    /// Whether any cell is blocked in a square of 64 x 64 cells; by band of rows, then square.
    std::vector<std::uint8_t> blocked_squares;
    bool finished = false;
  };
  /// Bounds of the distance of a point from the nearest blocked cell, in cells.
  struct Bounds {
    double least;
    double most;
  };

  bool free_of_cells(const Capsule& capsule) const;
  bool rectangles_free(const Capsule& capsule) const;
  bool columns_free(const Capsule& capsule) const;
  Bounds distance_from_cells(const Position& point) const;
  /// Whether a cell of a column is blocked; rows inclusive and inside the map.
  bool is_blocked(int column, int row_min, int row_max) const;
  /// Whether the squares of these rows in the 64 columns from `column` on, a multiple of 64, are free.
  bool squares_free(int column, int row_min, int row_max) const;

  int columns_;
  int rows_;
  double cells_per_metre_;
  std::shared_ptr<const Cells> cells_;
  BlockedPolygons polygons_;
};

}  // namespace fleetplan::core
