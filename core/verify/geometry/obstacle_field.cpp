#include "core/verify/geometry/obstacle_field.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

namespace fleetplan::core {

/// Branch and bound for the blocked cell nearest to a segment: blocks of cells are halved until they are all
/// free or all blocked, and dropped when they are too far away.
class ObstacleField::NearestCellSearch {
 public:
  /// Finds only cells that are nearer than `limit`, or as near and earlier on the segment.
  NearestCellSearch(const ObstacleField& field, const Position& from, const Position& to,
                    const NearestPoint& limit)
      : field_(field),
        from_(from),
        to_(to),
        low_(from.cwiseMin(to)),
        high_(from.cwiseMax(to)),
        nearest_(limit) {
    const double length = (to - from).norm();
    if (length > 0.0) normal_ = Position(from.y() - to.y(), to.x() - from.x()) / length;
  }

  void visit(const Block& block) {
    const std::int64_t blocked = field_.blocked_in(block);
    if (blocked == 0) return;
    const Rectangle rectangle = field_.rectangle(block);
    if (distance_bound(rectangle) > nearest_.distance) return;
    if (blocked == block.cells()) {
      consider(nearest_to_rectangle(from_, to_, rectangle));
      return;
    }
    Block one = block;
    Block other = block;
    if (block.last_column - block.first_column >= block.last_row - block.first_row) {
      one.last_column = other.first_column = std::midpoint(block.first_column, block.last_column);
    } else {
      one.last_row = other.first_row = std::midpoint(block.first_row, block.last_row);
    }
    // The nearer half comes first, as its result may exclude the other one.
    if (distance_bound(field_.rectangle(other)) < distance_bound(field_.rectangle(one)))
      std::swap(one, other);
    visit(one);
    visit(other);
  }

  std::optional<NearestPoint> result() const {
    return found_ ? std::optional<NearestPoint>(nearest_) : std::nullopt;
  }

 private:
  /// Returns a lower bound, up to rounding, of the distance between rectangle and segment: the distance to
  /// the segment's bounding box, or to its line.
  double distance_bound(const Rectangle& rectangle) const {
    const double dx = std::max({rectangle.low.x() - high_.x(), low_.x() - rectangle.high.x(), 0.0});
    const double dy = std::max({rectangle.low.y() - high_.y(), low_.y() - rectangle.high.y(), 0.0});
    const Position half = 0.5 * (rectangle.high - rectangle.low);
    const Position middle = rectangle.low + half;
    const double to_line = std::abs(normal_.dot(middle - from_)) - normal_.cwiseAbs().dot(half);
    return std::max(std::sqrt(dx * dx + dy * dy), to_line);
  }

  void consider(const NearestPoint& point) {
    const bool nearer = point.distance < nearest_.distance;
    const bool earlier = point.distance == nearest_.distance && point.fraction < nearest_.fraction;
    if (!nearer && !earlier) return;
    nearest_ = point;
    found_ = true;
  }

  const ObstacleField& field_;
  Position from_;
  Position to_;
  Position low_;
  Position high_;
  Position normal_{0.0, 0.0};  // normal to the segment, of length 1; 0 for a point
  NearestPoint nearest_;       // the nearest point so far
  bool found_ = false;
};

ObstacleField::ObstacleField(const OccupancyGrid& grid)
    : columns_(grid.columns()),
      rows_(grid.rows()),
      resolution_(grid.resolution()),
      width_(grid.width()),
      height_(grid.height()),
      blocked_below_left_(std::make_unique_for_overwrite<std::uint32_t[]>(corner(0, rows_ + 1))) {
  std::fill_n(blocked_below_left_.get(), columns_ + 1, 0);
  // Bounded: each cell once; 0.1 s for the largest map, most of it for the memory's pages.
  for (int row = 0; row < rows_; ++row) {
    std::uint32_t in_row = 0;
    blocked_below_left_[corner(0, row + 1)] = 0;
    for (int column = 0; column < columns_; ++column) {
      in_row += grid.blocked({column, row}) ? 1 : 0;
      blocked_below_left_[corner(column + 1, row + 1)] =
          blocked_below_left_[corner(column + 1, row)] + in_row;
    }
  }
}

std::optional<NearestObstacle> ObstacleField::nearest(const Position& from, const Position& to,
                                                      double reach) const {
  std::optional<NearestObstacle> nearest;
  const NearestPoint edge = nearest_edge(from, to);
  if (edge.distance < reach) nearest = NearestObstacle{edge, true};

  // Beyond the edge of the map the distance is 0; what remains is the part inside.
  const Stretch inside = stretch_inside(from, to, {Position(0.0, 0.0), Position(width_, height_)});
  if (inside.empty() || reach <= 0.0) return nearest;
  const Position enters = inside.first > 0.0 ? Position(from + inside.first * (to - from)) : from;
  const Position leaves = inside.last < 1.0 ? Position(from + inside.last * (to - from)) : to;
  const Block around = block_around(enters, leaves, reach);
  if (blocked_in(around) == 0) return nearest;
  // A cell must be nearer than the edge, or as near at an earlier point of the part inside.
  NearestPoint limit{reach, 0.0};
  if (nearest) limit = {edge.distance, inside.last > 0.0 ? edge.fraction / inside.last : 0.0};
  NearestCellSearch search(*this, enters, leaves, limit);
  search.visit(around);
  if (const std::optional<NearestPoint> cell = search.result()) {
    const double fraction = inside.first + cell->fraction * (inside.last - inside.first);
    nearest = NearestObstacle{{cell->distance, fraction}, false};
  }
  return nearest;
}

NearestPoint ObstacleField::nearest_edge(const Position& from, const Position& to) const {
  const std::array<double, 4> starts{from.x(), width_ - from.x(), from.y(), height_ - from.y()};
  const std::array<double, 4> ends{to.x(), width_ - to.x(), to.y(), height_ - to.y()};
  const double start = *std::min_element(starts.begin(), starts.end());
  const double end = *std::min_element(ends.begin(), ends.end());
  if (start <= 0.0) return {0.0, 0.0};
  if (end > 0.0) return start <= end ? NearestPoint{start, 0.0} : NearestPoint{end, 1.0};
  double crossing = 1.0;
  for (std::size_t side = 0; side < starts.size(); ++side) {
    if (ends[side] <= 0.0) crossing = std::min(crossing, starts[side] / (starts[side] - ends[side]));
  }
  return {0.0, crossing};
}

std::int64_t ObstacleField::blocked_in(const Block& block) const {
  return static_cast<std::int64_t>(blocked_below_left_[corner(block.last_column, block.last_row)]) -
         blocked_below_left_[corner(block.first_column, block.last_row)] -
         blocked_below_left_[corner(block.last_column, block.first_row)] +
         blocked_below_left_[corner(block.first_column, block.first_row)];
}

Rectangle ObstacleField::rectangle(const Block& block) const {
  return {Position(block.first_column * resolution_, block.first_row * resolution_),
          Position(block.last_column * resolution_, block.last_row * resolution_)};
}

ObstacleField::Block ObstacleField::block_around(const Position& from, const Position& to,
                                                 double reach) const {
  const auto clamped = [this](double coordinate, int last) {
    return static_cast<int>(std::clamp(std::floor(coordinate / resolution_), 0.0, static_cast<double>(last)));
  };
  const Position low = from.cwiseMin(to).array() - reach;
  const Position high = from.cwiseMax(to).array() + reach;
  return {clamped(low.x(), columns_ - 1), clamped(high.x(), columns_ - 1) + 1, clamped(low.y(), rows_ - 1),
          clamped(high.y(), rows_ - 1) + 1};
}

std::size_t ObstacleField::corner(int column, int row) const {
  return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_ + 1) +
         static_cast<std::size_t>(column);
}

}  // namespace fleetplan::core
