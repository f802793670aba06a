#include "core/map/fine_nodes.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/geometry/tolerance.h"

namespace fleetplan::core {
namespace {

/// Cells; far above the rounding of positions. Closer cases are left to LineOfSight.
constexpr double kUnclear = 1e-7;
/// Half the longest step, in pitches; a little more than half the square root of 2.
constexpr double kHalfDiagonal = 0.7072;

}  // namespace

FineNodes::FineNodes(const OccupancyGrid& grid, const DistanceTransform& distances, const LineOfSight& sight,
                     double radius, bool half)
    : distances_(distances),
      sight_(sight),
      radius_(radius),
      half_(half),
      pitch_(half ? 0.5 * grid.resolution() : grid.resolution()),
      columns_(half ? 2 * grid.columns() + 1 : grid.columns()),
      rows_(half ? 2 * grid.rows() + 1 : grid.rows()) {
  const double cells = std::max(0.0, radius - kSearchSlack) / grid.resolution();
  const double ample = cells + kHalfDiagonal * pitch_ / grid.resolution();
  for (std::size_t kind = 0; kind < limits_.size(); ++kind) {
    limits_[kind] = limits(kind / 2 == 1 ? 0.0 : -0.5, kind % 2 == 1 ? 0.0 : -0.5, cells, ample);
  }
}

/// For disks at (x, y) from the centre of a cell; all in cells.
FineNodes::Limits FineNodes::limits(double x, double y, double radius, double ample) {
  Limits limits{0, std::numeric_limits<int>::max(), 0};
  const double most = std::sqrt(static_cast<double>(DistanceTransform::kMostSquared)) - 2.0;
  if (ample > most) return {std::numeric_limits<int>::max(), 0, std::numeric_limits<int>::max()};
  const int reach = static_cast<int>(std::ceil(ample)) + 2;
  for (int row = -reach; row <= reach; ++row) {
    for (int column = -reach; column <= reach; ++column) {
      const double dx = std::max(std::abs(column - x) - 0.5, 0.0);
      const double dy = std::max(std::abs(row - y) - 0.5, 0.0);
      const double distance = std::sqrt(dx * dx + dy * dy);
      const int squared = column * column + row * row;
      if (distance < radius + kUnclear) limits.fits_from = std::max(limits.fits_from, squared + 1);
      if (distance < ample + kUnclear) limits.ample_from = std::max(limits.ample_from, squared + 1);
      if (distance >= radius - kUnclear) limits.blocked_below = std::min(limits.blocked_below, squared);
    }
  }
  return limits;
}

Cell FineNodes::nearest(const Position& position) const {
  const double shift = half_ ? 0.5 : 0.0;
  return {static_cast<int>(std::floor(position.x() / pitch_ + shift)),
          static_cast<int>(std::floor(position.y() / pitch_ + shift))};
}

/// A node on a grid line belongs to the cell to its right or above.
Cell FineNodes::cell_of(int column, int row) const {
  return half_ ? Cell{column / 2, row / 2} : Cell{column, row};
}

bool FineNodes::fits(int column, int row) const {
  if (on_edge(column, row)) return false;
  const int squared = distances_.squared(cell_of(column, row));
  const Limits& limits = limits_of(column, row);
  if (squared >= limits.fits_from) return clears_polygons(column, row, radius_);
  if (squared < limits.blocked_below) return false;
  return sight_.disk_fits(position(column, row), radius_);
}

bool FineNodes::is_ample(int column, int row) const {
  return !on_edge(column, row) &&
         distances_.squared(cell_of(column, row)) >= limits_of(column, row).ample_from &&
         clears_polygons(column, row, radius_ + kHalfDiagonal * pitch_);
}

}  // namespace fleetplan::core
