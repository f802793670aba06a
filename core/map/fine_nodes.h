#pragma once

#include <array>
#include <cstddef>

#include "core/geometry/position.h"
#include "core/map/distance_transform.h"
#include "core/map/line_of_sight.h"
#include "core/map/occupancy_grid.h"

namespace fleetplan::core {

/// A lattice finer than that of the search, and where a disk of one radius may be on it: the centres of the
/// cells, or also the middles between them. Exact; the distance transform decides nearly always.
class FineNodes {
 public:
  /// `half`: also the middles between cells. `radius` in metres.
  FineNodes(const OccupancyGrid& grid, const DistanceTransform& distances, const LineOfSight& sight,
            double radius, bool half);

  int columns() const { return columns_; }
  int rows() const { return rows_; }
  double pitch() const { return pitch_; }
  Position position(int column, int row) const {
    return half_ ? Position(column * pitch_, row * pitch_)
                 : Position((column + 0.5) * pitch_, (row + 0.5) * pitch_);
  }
  /// The node nearest to a position, perhaps beyond the map.
  Cell nearest(const Position& position) const;

  /// Whether the disk fits at the node.
  bool fits(int column, int row) const;
  /// Whether the disk fits at all places within half the longest step, too. True only where that is obvious.
  bool is_ample(int column, int row) const;
  /// Whether the disk may sweep the step between two nodes.
  bool may_sweep(const Cell& from, const Cell& to) const {
    return sight_.may_sweep(position(from.column, from.row), position(to.column, to.row), radius_);
  }

 private:
  /// Squared distances from the centre of the cell of a node to that of the nearest blocked one.
  struct Limits {
    int fits_from = 0;      // the disk fits
    int blocked_below = 0;  // it does not
    int ample_from = 0;
  };

  static Limits limits(double x, double y, double radius, double ample);
  Cell cell_of(int column, int row) const;
  const Limits& limits_of(int column, int row) const {
    return limits_[half_ ? static_cast<std::size_t>((column % 2) * 2 + row % 2) : 3];
  }
  bool clears_polygons(int column, int row, double radius) const {
    return sight_.polygons().empty() ||
           sight_.clears_polygons(position(column, row), position(column, row), radius);
  }
  bool on_edge(int column, int row) const {
    return half_ && (column == 0 || row == 0 || column + 1 == columns_ || row + 1 == rows_);
  }

  const DistanceTransform& distances_;
  const LineOfSight& sight_;
  double radius_;
  bool half_;
  double pitch_;
  int columns_;
  int rows_;
  std::array<Limits, 4> limits_{};  // of nodes on grid lines, and of centres of cells
};

}  // namespace fleetplan::core
