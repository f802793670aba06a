#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/geometry/position.h"
#include "core/map/occupancy_grid.h"
#include "core/runtime/arrays.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// A convex corner: a point where one blocked cell meets three free cells. Taut paths bend only around such
/// corners.
struct Corner {
  int x = 0;  // in cells
  int y = 0;
  int away_x = 1;  // the blocked cell is in direction (-away_x, -away_y)
  int away_y = 1;
};

/// The convex corners of the blocked cells, and which corners are visible from a point or from each other.
///
/// A disk may move straight from a point until it touches a corner, or from one corner to another. It then
/// covers the line between them, so the line must be free. The area that the disk covers is convex. So on
/// every grid line that it crosses, a stretch as wide as the disk must be free. The results may contain
/// corners that are not visible or not reachable. They never omit a corner that the disk can reach.
///
/// Visibility between corners is computed on first use, and only in the directions of taut paths. A path that
/// bends around a corner continues in one of the two quadrants beside the blocked cell. It leads neither over
/// the cell nor straight away from it. Not thread-safe.
class CornerVisibility {
 public:
  /// Finds corners for disks with radii from `least_radius` to `max_radius` (metres, >= 0).
  CornerVisibility(const OccupancyGrid& grid, double least_radius, double max_radius,
                   const StopCondition& stop);
  CornerVisibility(const CornerVisibility&) = delete;
  CornerVisibility& operator=(const CornerVisibility&) = delete;

  /// Whether the stop condition was met. From then on, corners and visibility may be incomplete.
  bool stopped() const { return stride_.met(); }
  /// Whether the stop condition was met, for loops over corners. Asks the condition only once in a while.
  bool stopped_at_step() { return stride_.met_at_step(); }

  const OccupancyGrid& grid() const { return grid_; }
  int count() const { return corners_.next_index(); }
  const Corner& corner(int index) const { return corners_[index]; }
  /// The position of a corner, metres.
  Position position(int index) const {
    return grid_.resolution() * Position(corner(index).x, corner(index).y);
  }

  /// The corners visible from a position (metres, free), ascending.
  std::vector<int> visible_from(const Position& position);
  /// The corners visible from another corner, in the directions in which taut paths continue there,
  /// ascending.
  const std::vector<int>& bends_from(int index);

  /// The work done so far: sectors followed through rows, and corners found. Each takes 10 to 20 ns.
  std::int64_t work() const { return work_; }

 private:
  struct Run {  // consecutive blocked cells of a row, from abscissa `begin` to `end`
    int begin;
    int end;
  };
  class View;

  void find_corners();
  void find_blocked_runs();
  std::vector<int> visible(double x, double y, const Corner* bend);
  /// The first corner on the grid line at x or beyond, or on a later line.
  int first_corner(int x, int line) const;

  const OccupancyGrid& grid_;
  double least_radius_;               // cells
  double max_radius_;                 // cells
  IndexedVector<Corner> corners_;     // by line, then abscissa
  IndexedVector<int> first_of_line_;  // by line, and the number of corners at the end
  IndexedVector<Run> runs_;           // by row; the first and last of a row reach to infinity
  IndexedVector<int> first_run_;      // by row, and the number of runs at the end
  IndexedVector<std::optional<std::vector<int>>> bends_from_;  // by corner
  std::int64_t work_ = 0;
  const StopCondition stop_;
  StopStride stride_;  // asks stop_
};

}  // namespace fleetplan::core
