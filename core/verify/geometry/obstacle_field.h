#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/map/occupancy_grid.h"
#include "core/verify/geometry/segment_distance.h"

namespace fleetplan::core {

/// The obstacle nearest to a segment.
struct NearestObstacle {
  NearestPoint point;
  bool is_edge = false;  // it is the edge of the map or the area beyond, not a blocked cell
};

/// All obstacles: the blocked cells of a map, and everything outside it.
class ObstacleField {
 public:
  /// Reads the map once, in time linear in its cells. `grid` outlives this object.
  explicit ObstacleField(const OccupancyGrid& grid);
  explicit ObstacleField(OccupancyGrid&&) = delete;

  /// Returns the first point of the segment from `from` to `to` (possibly equal) that is nearest to an
  /// obstacle, if that is nearer than `reach` metres. The error is a few ulp of the largest coordinate. Work
  /// grows with the number of blocked cells within `reach` of the part of the segment inside the map, not
  /// with its length.
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
