#pragma once

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

/// The convex corners of the blocked cells, and from where they are seen between the bare cells, whatever the
/// radius: a disk that moves straight from p until it touches a corner, or from one corner to another, covers
/// the line between them, so it needs that sight. May tell a corner more than is seen where only a line of no
/// width is free, never one less. Sight between corners is computed when first asked for; not thread-safe.
class CornerSight {
 public:
  explicit CornerSight(const OccupancyGrid& grid);

  const OccupancyGrid& grid() const { return grid_; }
  int count() const { return static_cast<int>(corners_.size()); }
  const Corner& corner(int index) const { return corners_[static_cast<std::size_t>(index)]; }
  /// Metres.
  Position position(int index) const;

  /// The corners seen from a position (metres, free) or from another corner, ascending.
  std::vector<int> seen_from(const Position& position) const;
  const std::vector<int>& seen_from_corner(int index);

 private:
  struct Run {  // blocked cells of a row, from abscissa `begin` to `end`
    int begin;
    int end;
  };
  struct Fan {  // directions dx / dy, closed
    double left;
    double right;
  };

  std::vector<int> seen(double x, double y) const;
  /// Rows above (`up`) or below.
  void scan(double x, double y, bool up, std::vector<int>& found) const;
  std::vector<Fan> through_row(const std::vector<Fan>& fans, double x, int row, double near,
                               double far) const;
  void find_on_line(const std::vector<Fan>& fans, double x, int line, double distance,
                    std::vector<int>& found) const;
  /// Along the grid line at `line`, on which the viewpoint lies.
  void look_along(double x, int line, std::vector<int>& found) const;
  std::optional<int> corner_at(int x, int line) const;

  const OccupancyGrid& grid_;
  std::vector<Corner> corners_;  // by line, then abscissa
  std::vector<int> abscissae_;   // of the corners, in cells
  std::vector<int> lines_;       // where a line's corners begin; rows + 2
  std::vector<Run> runs_;        // by row; with one from minus and one to plus infinity
  std::vector<int> rows_;        // where a row's runs begin; rows + 1
  std::vector<std::optional<std::vector<int>>> from_corner_;
};

}  // namespace fleetplan::core
