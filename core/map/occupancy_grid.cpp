#include "core/map/occupancy_grid.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <functional>

namespace fleetplan::core {

OccupancyGrid::OccupancyGrid(int columns, int rows, double resolution)
    : columns_(columns),
      rows_(rows),
      resolution_(resolution),
      blocked_(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows), 0) {}

std::size_t OccupancyGrid::hash() const {
  constexpr std::uint64_t kOdd = 0x9e3779b97f4a7c15;  // 2^64 over the golden ratio
  std::uint64_t hash = std::hash<double>{}(resolution_) + static_cast<std::uint64_t>(columns_);
  const auto mix = [&](std::uint64_t word) {
    hash = (hash ^ word) * kOdd;
    hash ^= hash >> 32U;
  };
  std::size_t at = 0;
  for (std::uint64_t word = 0; at + sizeof word <= blocked_.size(); at += sizeof word) {
    std::memcpy(&word, blocked_.data() + at, sizeof word);
    mix(word);
  }
  for (; at < blocked_.size(); ++at) mix(blocked_[at]);
  return hash;
}

Cell OccupancyGrid::cell_at(const Position& position) const {
  return {static_cast<int>(std::floor(position.x() / resolution_)),
          static_cast<int>(std::floor(position.y() / resolution_))};
}

namespace {

/// The distance of a coordinate from the cell of this column or row.
double distance_to_cell(double coordinate, int cell, double resolution) {
  return std::max({cell * resolution - coordinate, coordinate - (cell + 1) * resolution, 0.0});
}

}  // namespace

double obstacle_distance(const OccupancyGrid& grid, const Position& position, double limit) {
  const double edge =
      std::min({position.x(), position.y(), grid.width() - position.x(), grid.height() - position.y()});
  if (edge <= 0.0) return edge;
  double nearest = std::min(limit, edge);
  const double resolution = grid.resolution();
  const Cell centre = grid.cell_at(position);
  // Row after row away from the position, and in each row cell after cell, as long as they can be nearer.
  const auto look_along_row = [&](int row, double dy) {
    // Bounded: the cells of a row nearer than `limit`; a request has few faults whose distance is wanted.
    for (const int step : {1, -1}) {
      for (int column = centre.column; column >= 0 && column < grid.columns(); column += step) {
        const double dx = distance_to_cell(position.x(), column, resolution);
        if (dx >= nearest) break;
        if (!grid.blocked({column, row})) continue;
        nearest = std::min(nearest, std::hypot(dx, dy));
        break;
      }
    }
  };
  // Bounded: the rows nearer than `limit`.
  for (const int step : {1, -1}) {
    for (int row = centre.row; row >= 0 && row < grid.rows(); row += step) {
      const double dy = distance_to_cell(position.y(), row, resolution);
      if (dy >= nearest) break;
      look_along_row(row, dy);
    }
  }
  return nearest;
}

}  // namespace fleetplan::core
