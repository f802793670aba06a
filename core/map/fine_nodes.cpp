#include "core/map/fine_nodes.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/geometry/segment.h"
#include "core/geometry/tolerance.h"

namespace fleetplan::core {
namespace {

/// Cells; far above the rounding of positions. Closer cases are left to LineOfSight.
constexpr double kUnclear = 1e-7;
/// Cells: for larger disks, all steps are left to LineOfSight.
constexpr double kLargestDisk = 64.0;
/// Half the longest step, in pitches; a little more than half the square root of 2.
constexpr double kHalfDiagonal = 0.7072;

double distance_to_box(const Position& point, const Position& low, const Position& high) {
  return (low - point).cwiseMax(point - high).cwiseMax(0.0).norm();
}

}  // namespace

FineNodes::FineNodes(const OccupancyGrid& grid, const LineOfSight& sight, double radius, bool half)
    : grid_(grid),
      distances_(sight.distances()),
      sight_(sight),
      radius_(radius),
      half_(half),
      pitch_(half ? 0.5 * grid.resolution() : grid.resolution()),
      columns_(half ? 2 * grid.columns() + 1 : grid.columns()),
      rows_(half ? 2 * grid.rows() + 1 : grid.rows()) {
  const double cells = std::max(0.0, radius - kSearchSlack) / grid.resolution();
  const double pitch = pitch_ / grid.resolution();
  const double ample = cells + kHalfDiagonal * pitch;
  between_known_ = cells <= kLargestDisk;
  // Bounded: four kinds of nodes with eight neighbours.
  for (std::size_t kind = half ? 0 : 3; kind < limits_.size(); ++kind) {
    const Position node(kind / 2 == 1 ? 0.0 : -0.5, kind % 2 == 1 ? 0.0 : -0.5);
    limits_[kind] = limits(node.x(), node.y(), cells, ample);
    for (int step = 0; between_known_ && step < kSteps; ++step) {
      const Position to = node + pitch * Position(step % 3 - 1, step / 3 - 1);
      if (to != node) between_[kind][static_cast<std::size_t>(step)] = cells_between(node, to, cells);
    }
  }
}

/// For disks at (x, y) from the centre of a cell; all in cells.
FineNodes::Limits FineNodes::limits(double x, double y, double radius, double ample) {
  Limits limits{0, std::numeric_limits<int>::max(), 0};
  const double most = std::sqrt(static_cast<double>(DistanceTransform::kMostSquared)) - 2.0;
  if (ample > most) return {std::numeric_limits<int>::max(), 0, std::numeric_limits<int>::max()};
  const int reach = static_cast<int>(std::ceil(ample)) + 2;
  // Bounded: the cells within the longest distance of the transform, a quarter of a million.
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

/// The cells, from the one at the origin, that a disk overlaps on the way but perhaps not at its ends.
std::vector<Cell> FineNodes::cells_between(const Position& from, const Position& to, double radius) {
  std::vector<Cell> between;
  const Segment way{from, to};
  const int reach = static_cast<int>(std::ceil(radius)) + 2;
  // Bounded: the cells around a disk of at most kLargestDisk.
  for (int row = -reach; row <= reach; ++row) {
    for (int column = -reach; column <= reach; ++column) {
      const Position low(column - 0.5, row - 0.5);
      const Position high(column + 0.5, row + 0.5);
      const double at_ends = std::min(distance_to_box(from, low, high), distance_to_box(to, low, high));
      if (at_ends < radius - kUnclear) continue;
      const double nearest = std::min({at_ends, distance_to_segment(low, way), distance_to_segment(high, way),
                                       distance_to_segment({low.x(), high.y()}, way),
                                       distance_to_segment({high.x(), low.y()}, way)});
      if (nearest < radius + kUnclear) between.push_back({column, row});
    }
  }
  return between;
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

bool FineNodes::may_step(const Cell& from, const Cell& to) const {
  const auto& steps = between_[kind_of(from.column, from.row)];
  const std::vector<Cell>& between = steps[step_index(to.column - from.column, to.row - from.row)];
  const Cell cell = cell_of(from.column, from.row);
  const Position begin = position(from.column, from.row);
  const Position end = position(to.column, to.row);
  const bool is_free =
      between_known_ && std::none_of(between.begin(), between.end(), [&](const Cell& offset) {
        return grid_.blocked({cell.column + offset.column, cell.row + offset.row});
      });
  return is_free ? sight_.clears_polygons(begin, end, radius_) : sight_.may_sweep(begin, end, radius_);
}

bool FineNodes::is_ample(int column, int row) const {
  return !on_edge(column, row) &&
         distances_.squared(cell_of(column, row)) >= limits_of(column, row).ample_from &&
         clears_polygons(column, row, radius_ + kHalfDiagonal * pitch_);
}

}  // namespace fleetplan::core
