#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/geometry/position.h"
#include "core/map/occupancy_grid.h"

namespace fleetplan::core {

/// A point where one blocked cell meets three free ones: what a taut path may bend around.
struct Corner {
  int x = 0;  // in cells
  int y = 0;
  int away_x = 1;  // the blocked cell lies towards (-away_x, -away_y)
  int away_y = 1;
};

/// The convex corners of the blocked cells, and from where they are seen between the bare cells. A disk that
/// moves straight from p until it touches a corner, or from one corner to another, covers the line between
/// them, so it needs that sight; and as what it covers is convex, it needs all the sight to where it crosses
/// a grid line. May tell more corners than are seen or reached, never fewer than the disk reaches. Sight
/// between corners is computed when first asked for, and only where taut paths lead: a path that bends around
/// a corner goes on in one of the two quadrants beside the blocked cell, neither over the cell nor straight
/// away from it. Not thread-safe.
class CornerSight {
 public:
  /// For disks of radii from `least` to `most` (metres, >= 0).
  CornerSight(const OccupancyGrid& grid, double least, double most);

  const OccupancyGrid& grid() const { return grid_; }
  int count() const { return static_cast<int>(corners_.size()); }
  const Corner& corner(int index) const { return corners_[static_cast<std::size_t>(index)]; }
  /// Metres.
  Position position(int index) const {
    return grid_.resolution() * Position(corner(index).x, corner(index).y);
  }

  /// The corners seen from a position (metres, free), ascending.
  std::vector<int> seen_from(const Position& position);
  /// Those seen from another corner to which taut paths may lead on from there, ascending.
  const std::vector<int>& bends_from(int index);

  /// The work done so far: fans of sight followed through rows, and corners found; each takes 10 to 20 ns.
  std::int64_t work() const { return work_; }

 private:
  struct Run {  // blocked cells of a row, from abscissa `begin` to `end`
    int begin;
    int end;
  };
  class View;

  std::vector<int> seen(double x, double y, const Corner* bend);
  /// The first corner on the line at x or beyond, or on a later line.
  int first_corner(int x, int line) const;

  const OccupancyGrid& grid_;
  double least_;                 // radius, in cells
  double most_;                  // radius, in cells
  std::vector<Corner> corners_;  // by line, then abscissa
  std::vector<int> before_;      // corners before each grid point, in the same order; and all at the end
  std::vector<Run> runs_;        // by row; with one from minus and one to plus infinity
  std::vector<int> rows_;        // where a row's runs begin; rows + 1
  std::vector<std::optional<std::vector<int>>> from_corner_;
  std::int64_t work_ = 0;
};

}  // namespace fleetplan::core
