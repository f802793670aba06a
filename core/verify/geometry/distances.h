#pragma once

// The distance of a segment from rectangles, polygons and the obstacles of a map, and the parts of the
// segment inside them.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/geometry/position.h"
#include "core/map/occupancy_grid.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// A closed axis-aligned rectangle, metres.
struct Rectangle {
  Position low{0.0, 0.0};
  Position high{0.0, 0.0};
};

/// The part of a segment between two fractions of its length; all of it by default.
struct Stretch {
  double first = 0.0;
  double last = 1.0;
  bool empty() const { return first > last; }
};

/// The smallest distance, and the first point of the segment with this distance.
struct NearestPoint {
  double distance = 0.0;  // metres, 0 inside
  double fraction = 0.0;  // share of the segment, 0 to 1
};

/// Returns the part of the segment from `from` to `to` (possibly equal) inside the rectangle.
Stretch stretch_inside(const Position& from, const Position& to, const Rectangle& rectangle);

/// Returns the nearest point of a segment (or a point, if `from` == `to`) to a rectangle, and their distance.
/// The error is a few ulp of the largest coordinate.
NearestPoint nearest_to_rectangle(const Position& from, const Position& to, const Rectangle& rectangle);

/// Whether a point is inside a simple polygon, by its winding number. Within rounding of the border, either
/// answer is possible.
bool is_inside(const std::vector<Position>& corners, const Position& point);

/// Whether a point is inside and farther than `depth` metres from the border.
bool is_deep_inside(const std::vector<Position>& corners, const Position& point, double depth);

/// Returns the first point of a segment that is nearest to a simple polygon with its inside, and their
/// distance. If `from` == `to`, the segment is a point. If the segment enters the polygon, this is the first
/// point inside.
NearestPoint nearest_to_polygon(const Position& from, const Position& to,
                                const std::vector<Position>& corners);

/// Returns the stretches of a segment, of length > 0, inside the polygon, ascending. The quarter points of a
/// stretch are inside, and not all within `depth` metres of the border. Once `stop` is met, returns only the
/// first stretches.
std::vector<Stretch> stretches_inside(const Position& from, const Position& to,
                                      const std::vector<Position>& corners, double depth,
                                      const StopCondition& stop);

/// The obstacle nearest to a segment.
struct NearestObstacle {
  NearestPoint point;
  bool is_edge = false;  // it is the edge of the map or the area beyond, not a blocked cell
};

/// All obstacles: the blocked cells of a map, and everything outside it.
class ObstacleField {
 public:
  /// Reads the map once, in time linear in its cells. `grid` must outlive this object.
  explicit ObstacleField(const OccupancyGrid& grid);
  explicit ObstacleField(OccupancyGrid&&) = delete;

  /// Returns the first point of the segment from `from` to `to` (possibly equal) that is nearest to an
  /// obstacle. None unless it is nearer than `reach` metres. The error is a few ulp of the largest
  /// coordinate.
  ///
  /// Work grows with the number of blocked cells within `reach` of the part of the segment inside the map,
  /// not with the segment's length.
  std::optional<NearestObstacle> nearest(const Position& from, const Position& to, double reach) const;

 private:
  /// Columns and rows from first (included) to last (excluded): of tiles, or of cells.
  struct Block {
    int first_column, last_column, first_row, last_row;
    std::int64_t area() const {
      return static_cast<std::int64_t>(last_column - first_column) * (last_row - first_row);
    }
  };
  class NearestCellSearch;

  NearestPoint nearest_edge(const Position& from, const Position& to) const;
  std::int64_t blocked_in(const Block& tiles) const;
  Block cells_of(const Block& tiles) const;
  Rectangle rectangle(const Block& cells) const;
  Block tiles_around(const Position& from, const Position& to, double reach) const;
  std::size_t corner(int column, int row) const;

  const OccupancyGrid& grid_;
  int tile_columns_;
  int tile_rows_;
  /// The number of blocked cells below and to the left of each corner of a tile, row by row from the bottom.
  std::vector<std::uint32_t> blocked_below_left_;
};

}  // namespace fleetplan::core
