#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "core/geometry/position.h"
#include "core/map/lattice.h"
#include "core/map/line_of_sight.h"
#include "core/map/occupancy_grid.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// A lattice finer than the lattice of the search, with the nodes where a disk of one radius may be. Nodes
/// are the centres of the cells, and perhaps also the middles between them. Exact; the distance transform
/// decides nearly always.
class FineNodes {
 public:
  /// The nodes for a disk of `radius` metres. `half`: whether the middles between cells are nodes, too.
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
  /// Whether the disk fits at all places within half the longest step from the node. True only where that is
  /// easy to see.
  bool is_ample(int column, int row) const;
  /// Whether tests take up to thousands of times as long as usual: for large disks, or among polygons.
  bool are_costly() const { return !between_known_ || !sight_.polygons().empty(); }
  /// Whether the disk may sweep the step between two neighbouring nodes at which it fits.
  bool may_step(const Cell& from, const Cell& to) const;

 private:
  /// Squared distances from the centre of a node's cell to the centre of the nearest blocked cell. They
  /// decide whether the disk fits at the node.
  struct Limits {
    int fits_from = 0;      // the disk fits
    int blocked_below = 0;  // the disk does not fit
    int ample_from = 0;
  };

  static constexpr int kSteps = 9;  // steps to the neighbours and, unused, to the node itself

  static Limits limits(double x, double y, double radius, double ample);
  static std::vector<Cell> cells_between(const Position& from, const Position& to, double radius);
  static std::size_t step_index(int columns, int rows) {
    return 3 * static_cast<std::size_t>(rows + 1) + static_cast<std::size_t>(columns + 1);
  }
  Cell cell_of(int column, int row) const;
  /// The kind of a node, 0 to 3: on both grid lines, on a vertical line, on a horizontal line, or on no line.
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
  /// The cells that a step may sweep although the disk fits at both ends, relative to the node's cell. By
  /// kind of node and step. Not known for large disks.
  std::array<std::array<std::vector<Cell>, kSteps>, 4> between_;
  bool between_known_;
};

/// The fine nodes where a disk fits, each with the nearest vertex of the lattice along steps between nodes: a
/// brushfire from all vertices. Nodes farther than a few spacings from any vertex get additional vertices.
/// Blocks of nodes that are open everywhere are not searched; all vertices in them are linked.
class FineRegions {
 public:
  /// Lengths are in fifths of the pitch of the nodes. A diagonal step counts 7.
  static constexpr int kAxis = 5;
  static constexpr int kDiagonal = 7;

  /// Two neighbouring nodes in the regions of different vertices.
  struct Touch {
    Cell one;
    Cell other;
    int one_vertex = -1;
    int other_vertex = -1;
    int length = 0;  // from vertex to vertex
  };

  FineRegions(const FineNodes& nodes, const Lattice& lattice, double radius, const LineOfSight& sight);

  /// Finds the regions. Returns false if the stop condition was met first.
  bool find(const StopCondition& condition);

  /// The additional vertices. Their ids follow the ids of the lattice.
  const std::vector<Position>& added() const { return added_; }
  /// The position of a vertex of the lattice or of an additional one, metres.
  Position position(int vertex) const;

  /// Calls visit(touch) for all places where regions touch, until the stop condition is met. Does not test
  /// whether the step between them is free.
  template <class Visitor>
  void for_each_touch(StopStride& stop, Visitor&& visit) const;

  /// Returns the nodes on the way from a node to its vertex, both included.
  std::vector<Position> way_from(Cell here) const;

 private:
  struct Node {
    std::int32_t vertex = -1;
    std::uint16_t length = 0;  // to the vertex
    std::int8_t step = -1;     // towards it
    bool fits : 1 = false;
    bool ample : 1 = false;
  };
  struct Step {
    int columns, rows, length;
  };
  static const Step kSteps[8];

  enum : std::int32_t { kClosed = -1, kOpen = -2 };

  void classify(int block_column, int block_row, StopStride& stop);
  std::optional<int> vertex_in_open_block(const Cell& node) const;
  void begin_at_vertices(int block, StopStride& stop);
  void begin_at_open_blocks(int block, StopStride& stop);
  void add_vertices(int block, StopStride& stop);
  void put(const Cell& here, int vertex, int length, int step);
  void spread(bool only_unreached, StopStride& stop);
  std::vector<int> nearest_in_blocks(int nodes, int vertices) const;
  bool may_step(const Cell& from, const Node& from_node, const Cell& to, const Node& to_node) const;
  int length_to(const Cell& node, int vertex) const;

  bool inside(const Cell& node) const {
    return node.column >= 0 && node.row >= 0 && node.column < nodes_.columns() && node.row < nodes_.rows();
  }
  std::size_t block_of(const Cell& node) const {
    return static_cast<std::size_t>(node.row >> side_bits_) * static_cast<std::size_t>(block_columns_) +
           static_cast<std::size_t>(node.column >> side_bits_);
  }
  /// Returns the node; null in open and closed blocks.
  Node* find_node(const Cell& node) { return const_cast<Node*>(std::as_const(*this).find_node(node)); }
  const Node* find_node(const Cell& node) const {
    const std::int32_t begin = blocks_[block_of(node)];
    if (begin < 0) return nullptr;
    const int mask = side_ - 1;
    const int in_block = ((node.row & mask) << side_bits_) + (node.column & mask);
    return &searched_[(static_cast<std::size_t>(begin) << 2 * side_bits_) +
                      static_cast<std::size_t>(in_block)];
  }
  bool in_open_block(const Cell& node) const { return blocks_[block_of(node)] == kOpen; }

  const FineNodes& nodes_;
  const Lattice& lattice_;
  double radius_;
  const LineOfSight& sight_;
  int side_bits_;
  int side_;   // nodes along a side of a block: 2 to the power of side_bits_
  int limit_;  // length of the longest way to a vertex
  int block_columns_;
  int block_rows_;
  std::vector<int> nearest_column_;   // by column of nodes: the nearest column of the lattice
  std::vector<int> nearest_row_;      // by row of nodes: the nearest row of the lattice
  std::vector<std::int32_t> blocks_;  // kClosed, kOpen, or its number in searched_
  std::vector<Cell> begin_of_block_;  // first node of each block that is searched
  std::vector<Node> searched_;
  std::vector<std::vector<Cell>> front_;  // nodes by length of their way
  std::vector<Position> added_;
};

template <class Visitor>
void FineRegions::for_each_touch(StopStride& stop, Visitor&& visit) const {
  for (const Cell& begin : begin_of_block_) {
    for (int row = begin.row; row < std::min(begin.row + side_, nodes_.rows()); ++row) {
      if (stop.met_at_step()) return;
      for (int column = begin.column; column < std::min(begin.column + side_, nodes_.columns()); ++column) {
        const Cell here{column, row};
        const Node& node = *find_node(here);
        if (node.vertex < 0) continue;
        for (int k = 0; k < 8; ++k) {
          const Cell next{column + kSteps[k].columns, row + kSteps[k].rows};
          if (!inside(next)) continue;
          if (const Node* other = find_node(next)) {
            if (k >= 4 || other->vertex < 0 || other->vertex == node.vertex) continue;
            visit(Touch{here, next, node.vertex, other->vertex,
                        node.length + kSteps[k].length + other->length});
          } else if (const auto vertex = vertex_in_open_block(next); vertex && *vertex != node.vertex) {
            const int length = node.length + kSteps[k].length + length_to(next, *vertex);
            visit(Touch{here, next, node.vertex, *vertex, length});
          }
        }
      }
    }
  }
}

}  // namespace fleetplan::core
