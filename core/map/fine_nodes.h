#pragma once

#include <array>
#include <cstddef>
#include <vector>

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
  FineNodes(const OccupancyGrid& grid, const LineOfSight& sight, double radius, bool half);

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
  /// Whether tests take up to thousands of times as long as usual: of large disks, or among polygons.
  bool are_costly() const { return !between_known_ || !sight_.polygons().empty(); }
  /// Whether the disk, which fits at two neighbouring nodes, may sweep the step between them.
  bool may_step(const Cell& from, const Cell& to) const;

 private:
  /// Squared distances from the centre of the cell of a node to that of the nearest blocked one.
  struct Limits {
    int fits_from = 0;      // the disk fits
    int blocked_below = 0;  // it does not
    int ample_from = 0;
  };

  static constexpr int kSteps = 9;  // to the neighbours and, unused, to the node itself

  static Limits limits(double x, double y, double radius, double ample);
  static std::vector<Cell> cells_between(const Position& from, const Position& to, double radius);
  static std::size_t step_index(int columns, int rows) {
    return 3 * static_cast<std::size_t>(rows + 1) + static_cast<std::size_t>(columns + 1);
  }
  Cell cell_of(int column, int row) const;
  /// Of nodes on grid lines, and of centres of cells.
  std::size_t kind_of(int column, int row) const {
    return half_ ? static_cast<std::size_t>((column % 2) * 2 + row % 2) : 3;
  }
  const Limits& limits_of(int column, int row) const { return limits_[kind_of(column, row)]; }
  bool clears_polygons(int column, int row, double radius) const {
    return sight_.polygons().empty() ||
           sight_.clears_polygons(position(column, row), position(column, row), radius);
  }
  bool on_edge(int column, int row) const {
    return half_ && (column == 0 || row == 0 || column + 1 == columns_ || row + 1 == rows_);
  }

  const OccupancyGrid& grid_;
  const DistanceTransform& distances_;
  const LineOfSight& sight_;
  double radius_;
  bool half_;
  double pitch_;
  int columns_;
  int rows_;
  std::array<Limits, 4> limits_{};  // by kind of node
  /// The cells, from that of the node, that a step may sweep although the disk fits at both ends: by kind of
  /// node and step. Not known for large disks.
  std::array<std::array<std::vector<Cell>, kSteps>, 4> between_;
  bool between_known_;
};

}  // namespace fleetplan::core
