#include "core/map/fine_regions.h"

#include <bit>
#include <cmath>
#include <limits>

#include "core/geometry/segment.h"
#include "core/geometry/tolerance.h"

namespace fleetplan::core {
namespace {

/// The difference, in cells, below which cases are left to LineOfSight: far above the rounding of positions.
constexpr double kUnclear = 1e-7;
/// The largest radius, in cells, whose steps are tested here; for larger disks all steps are left to
/// LineOfSight.
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

/// Returns the limits for disks at (x, y) from the centre of a cell; all in cells.
FineNodes::Limits FineNodes::limits(double x, double y, double radius, double ample) {
  Limits limits{0, std::numeric_limits<int>::max(), 0};
  const double max_distance = std::sqrt(static_cast<double>(DistanceTransform::kMaxSquared)) - 2.0;
  if (ample > max_distance) return {std::numeric_limits<int>::max(), 0, std::numeric_limits<int>::max()};
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

/// Returns the cells, from the cell at the origin, that a disk overlaps on the way but perhaps not at its
/// ends.
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

/// The cell of a node. A node on a grid line belongs to the cell to its right or above.
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

namespace {

/// The least side of a block, in nodes: smaller blocks fit walls better, larger ones are fewer.
constexpr unsigned kLeastSide = 8;
/// The longest way of a node to its vertex, in spacings, along steps between nodes.
constexpr double kFarthest = 2.5;
/// Nodes between two checks of the stop condition; fewer where each of them takes long.
constexpr std::size_t kBlocksBetweenPolls = 1024;
constexpr std::size_t kCostlyStopStride = 4;

}  // namespace

const FineRegions::Step FineRegions::kSteps[8] = {{1, 0, kAxis},       {0, 1, kAxis},     {1, 1, kDiagonal},
                                                  {-1, 1, kDiagonal},  {-1, 0, kAxis},    {0, -1, kAxis},
                                                  {-1, -1, kDiagonal}, {1, -1, kDiagonal}};

FineRegions::FineRegions(const FineNodes& nodes, const Lattice& lattice, double radius,
                         const LineOfSight& sight)
    : nodes_(nodes),
      lattice_(lattice),
      radius_(radius),
      sight_(sight),
      side_bits_(std::bit_width(
          std::max(kLeastSide - 1, static_cast<unsigned>(std::ceil(lattice.spacing() / nodes.pitch()))))),
      side_(1 << side_bits_),
      limit_(static_cast<int>(
          std::clamp(kFarthest * lattice.spacing() / nodes.pitch() * kAxis, 4.0 * kAxis, 30000.0))),
      block_columns_((nodes.columns() + side_ - 1) / side_),
      block_rows_((nodes.rows() + side_ - 1) / side_),
      nearest_column_(nearest_in_blocks(nodes.columns(), lattice.columns())),
      nearest_row_(nearest_in_blocks(nodes.rows(), lattice.rows())),
      blocks_(static_cast<std::size_t>(block_columns_) * static_cast<std::size_t>(block_rows_), kClosed),
      front_(static_cast<std::size_t>(limit_) + 1) {}

Position FineRegions::position(int vertex) const {
  return vertex < lattice_.vertex_count()
             ? lattice_.position(vertex)
             : added_[static_cast<std::size_t>(vertex - lattice_.vertex_count())];
}

bool FineRegions::find(const StopCondition& condition) {
  StopStride stop(condition, nodes_.are_costly() ? kCostlyStopStride : kBlocksBetweenPolls);
  for (int row = 0; row < block_rows_ && !stop.met(); ++row) {
    for (int column = 0; column < block_columns_ && !stop.met(); ++column) classify(column, row, stop);
  }
  const auto count = static_cast<int>(begin_of_block_.size());
  for (int block = 0; block < count && !stop.met(); ++block) begin_at_vertices(block, stop);
  for (int block = 0; block < count && !stop.met(); ++block) begin_at_open_blocks(block, stop);
  spread(false, stop);
  for (int block = 0; block < count && !stop.met(); ++block) add_vertices(block, stop);
  return !stop.met();
}

/// Adds vertices to a block where the disk fits but no way leads to a vertex.
void FineRegions::add_vertices(int block, StopStride& stop) {
  const Cell begin = begin_of_block_[static_cast<std::size_t>(block)];
  for (int k = 0; k < side_ * side_ && !stop.met_at_step(); ++k) {
    const Cell here{begin.column + k % side_, begin.row + k / side_};
    if (!inside(here)) continue;
    const Node* node = find_node(here);
    if (!node->fits || node->vertex >= 0) continue;
    added_.push_back(nodes_.position(here.column, here.row));
    put(here, lattice_.vertex_count() + static_cast<int>(added_.size()) - 1, 0, -1);
    spread(true, stop);
  }
}

/// Finds out where the disk fits in a block.
void FineRegions::classify(int block_column, int block_row, StopStride& stop) {
  const Cell begin{block_column * side_, block_row * side_};
  const int columns = std::min(side_, nodes_.columns() - begin.column);
  const int rows = std::min(side_, nodes_.rows() - begin.row);
  std::vector<Node> found(static_cast<std::size_t>(side_ * side_));
  bool open = true;
  bool closed = true;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      if (stop.met_at_step()) return;
      Node& node = found[static_cast<std::size_t>(row) * static_cast<std::size_t>(side_) +
                         static_cast<std::size_t>(column)];
      node.ample = nodes_.is_ample(begin.column + column, begin.row + row);
      node.fits = node.ample || nodes_.fits(begin.column + column, begin.row + row);
      open = open && node.ample;
      closed = closed && !node.fits;
    }
  }
  if (closed) return;
  std::int32_t& block = blocks_[block_of(begin)];
  block = kOpen;
  if (open && vertex_in_open_block(begin)) return;
  block = static_cast<std::int32_t>(begin_of_block_.size());
  begin_of_block_.push_back(begin);
  searched_.insert(searched_.end(), found.begin(), found.end());
}

/// Returns, for every column (or row) of nodes, the nearest column (or row) of the lattice within the same
/// block. -1 if there is none.
std::vector<int> FineRegions::nearest_in_blocks(int nodes, int vertices) const {
  const auto along_axis = [&](int node) { return nodes_.position(node, node).x(); };
  const double rounding = 1e-6 * nodes_.pitch();
  std::vector<int> nearest(static_cast<std::size_t>(nodes), -1);
  for (int node = 0; node < nodes; ++node) {
    const int first = node / side_ * side_;
    const int last = std::min(first + side_, nodes) - 1;
    const double low = along_axis(first) - rounding;
    const double high = along_axis(last) + rounding;
    const int from = std::max(0, static_cast<int>(std::ceil(low / lattice_.spacing() - 0.5)));
    const int to = std::min(vertices - 1, static_cast<int>(std::floor(high / lattice_.spacing() - 0.5)));
    if (from > to) continue;
    const int beside = static_cast<int>(std::floor(along_axis(node) / lattice_.spacing()));
    nearest[static_cast<std::size_t>(node)] = std::clamp(beside, from, to);
  }
  return nearest;
}

/// Returns the vertex of the lattice nearest to a node of an open block, if the block has one.
std::optional<int> FineRegions::vertex_in_open_block(const Cell& node) const {
  if (!in_open_block(node)) return std::nullopt;
  const int column = nearest_column_[static_cast<std::size_t>(node.column)];
  const int row = nearest_row_[static_cast<std::size_t>(node.row)];
  if (column < 0 || row < 0) return std::nullopt;
  return lattice_.vertex(column, row);
}

int FineRegions::length_to(const Cell& node, int vertex) const {
  const double metres = (nodes_.position(node.column, node.row) - position(vertex)).norm();
  const double up_to_next = metres / nodes_.pitch() * kAxis + 0.5;
  return static_cast<int>(up_to_next);
}

/// Begins the brushfire at the vertices of the lattice in a block.
void FineRegions::begin_at_vertices(int block, StopStride& stop) {
  const Cell begin = begin_of_block_[static_cast<std::size_t>(block)];
  const Position low = nodes_.position(begin.column, begin.row);
  const double margin = 0.51 * nodes_.pitch();
  const double spacing = lattice_.spacing();
  const double size = (side_ - 1) * nodes_.pitch() + margin;
  const auto first = [&](double x) {
    return std::max(0, static_cast<int>(std::ceil((x - margin) / spacing - 0.5)));
  };
  const auto last = [&](double x, int count) {
    return std::min(count - 1, static_cast<int>(std::floor((x + size) / spacing - 0.5)));
  };
  for (int row = first(low.y()); row <= last(low.y(), lattice_.rows()); ++row) {
    for (int column = first(low.x()); column <= last(low.x(), lattice_.columns()); ++column) {
      if (stop.met_at_step()) return;
      const int vertex = lattice_.vertex(column, row);
      const Cell node = nodes_.nearest(lattice_.position(vertex));
      if (!inside(node) || blocks_[block_of(node)] != block || !find_node(node)->fits) continue;
      const Position at = nodes_.position(node.column, node.row);
      if (!sight_.may_sweep(lattice_.position(vertex), at, radius_)) continue;
      put(node, vertex, length_to(node, vertex), -1);
    }
  }
}

/// Begins the brushfire at the nodes of a block beside open blocks.
void FineRegions::begin_at_open_blocks(int block, StopStride& stop) {
  const Cell begin = begin_of_block_[static_cast<std::size_t>(block)];
  for (int k = 0; k < side_ * side_; ++k) {
    const Cell here{begin.column + k % side_, begin.row + k / side_};
    const bool inner = k % side_ > 0 && k % side_ < side_ - 1 && k / side_ > 0 && k / side_ < side_ - 1;
    if (inner || !inside(here) || !find_node(here)->fits) continue;
    if (stop.met_at_step()) return;
    for (int step = 0; step < 8; ++step) {
      const Cell next{here.column + kSteps[step].columns, here.row + kSteps[step].rows};
      if (!inside(next)) continue;
      const auto vertex = vertex_in_open_block(next);
      if (!vertex || !nodes_.may_step(here, next)) continue;
      put(here, *vertex, kSteps[step].length + length_to(next, *vertex), step);
    }
  }
}

/// Reaches a node, unless it was reached before on a way that is no longer.
void FineRegions::put(const Cell& here, int vertex, int length, int step) {
  Node& node = *find_node(here);
  if (length > limit_ || (node.vertex >= 0 && node.length <= length)) return;
  node.vertex = vertex;
  node.length = static_cast<std::uint16_t>(length);
  node.step = static_cast<std::int8_t>(step);
  front_[static_cast<std::size_t>(length)].push_back(here);
}

bool FineRegions::may_step(const Cell& from, const Node& from_node, const Cell& to,
                           const Node& to_node) const {
  return (from_node.ample && to_node.ample) || nodes_.may_step(from, to);
}

void FineRegions::spread(bool only_unreached, StopStride& stop) {
  for (int length = 0; length <= limit_; ++length) {
    auto& front = front_[static_cast<std::size_t>(length)];
    for (std::size_t k = 0; k < front.size(); ++k) {
      if (stop.met_at_step()) return;
      const Cell here = front[k];
      const Node node = *find_node(here);
      if (node.length != length) continue;
      for (int step = 0; step < 8; ++step) {
        const Cell next{here.column + kSteps[step].columns, here.row + kSteps[step].rows};
        if (!inside(next)) continue;
        const Node* other = find_node(next);
        const int there = length + kSteps[step].length;
        if (other == nullptr || !other->fits || (other->vertex >= 0 && other->length <= there)) continue;
        if (only_unreached && other->vertex >= 0 && other->vertex != node.vertex) continue;
        if (may_step(here, node, next, *other)) put(next, node.vertex, there, (step + 4) % 8);
      }
    }
    front.clear();
  }
}

std::vector<Position> FineRegions::way_from(Cell here) const {
  std::vector<Position> way{nodes_.position(here.column, here.row)};
  const Node* node = find_node(here);
  int vertex = node != nullptr ? node->vertex : vertex_in_open_block(here).value();
  while (node != nullptr && node->step >= 0) {
    here = {here.column + kSteps[node->step].columns, here.row + kSteps[node->step].rows};
    way.push_back(nodes_.position(here.column, here.row));
    node = find_node(here);
  }
  way.push_back(position(vertex));
  return way;
}

}  // namespace fleetplan::core
