#include "core/map/obstacle_distance.h"

#include <algorithm>
#include <cmath>

namespace fleetplan::core {

double obstacle_distance(const OccupancyGrid& grid, const Position& position, double limit) {
  const double edge =
      std::min({position.x(), position.y(), grid.width() - position.x(), grid.height() - position.y()});
  if (edge <= 0.0) return edge;
  double nearest = std::min(limit, edge);
  const double resolution = grid.resolution();
  const Cell low = grid.cell_at(position - Position(nearest, nearest));
  const Cell high = grid.cell_at(position + Position(nearest, nearest));
  for (int row = std::max(0, low.row); row <= std::min(grid.rows() - 1, high.row); ++row) {
    for (int column = std::max(0, low.column); column <= std::min(grid.columns() - 1, high.column);
         ++column) {
      if (!grid.blocked({column, row})) continue;
      const double dx =
          std::max({column * resolution - position.x(), position.x() - (column + 1) * resolution, 0.0});
      const double dy =
          std::max({row * resolution - position.y(), position.y() - (row + 1) * resolution, 0.0});
      nearest = std::min(nearest, std::hypot(dx, dy));
    }
  }
  return nearest;
}

}  // namespace fleetplan::core
