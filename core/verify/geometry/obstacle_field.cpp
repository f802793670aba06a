#include "core/verify/geometry/obstacle_field.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

namespace fleetplan::core {
namespace {

/// The cells of a map are counted in square tiles with sides of so many. Smaller ones cost memory and time
/// for maps, larger ones time for segments.
constexpr int kTile = 8;

int tiles_for(int cells) { return (cells + kTile - 1) / kTile; }

}  // namespace

/// Branch and bound for the blocked cell nearest to a segment: blocks of tiles are halved until they are all
/// free, all blocked, or one tile, and dropped when they are too far away.
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

  void visit(const Block& tiles) {
    const std::int64_t blocked = field_.blocked_in(tiles);
    if (blocked == 0) return;
    const Block cells = field_.cells_of(tiles);
    const Rectangle rectangle = field_.rectangle(cells);
    if (distance_bound(rectangle) > nearest_.distance) return;
    if (blocked == cells.area()) {
      consider(nearest_to_rectangle(from_, to_, rectangle));
      return;
    }
    if (tiles.area() == 1) {
      visit_cells(cells);
      return;
    }
    Block one = tiles;
    Block other = tiles;
    if (tiles.last_column - tiles.first_column >= tiles.last_row - tiles.first_row) {
      one.last_column = other.first_column = std::midpoint(tiles.first_column, tiles.last_column);
    } else {
      one.last_row = other.first_row = std::midpoint(tiles.first_row, tiles.last_row);
    }
    // The nearer half comes first, as its result may exclude the other one.
    if (distance_bound(field_.rectangle(field_.cells_of(other))) <
        distance_bound(field_.rectangle(field_.cells_of(one)))) {
      std::swap(one, other);
    }
    visit(one);
    visit(other);
  }

  std::optional<NearestPoint> result() const {
    return found_ ? std::optional<NearestPoint>(nearest_) : std::nullopt;
  }

 private:
  /// Looks at the blocked cells one by one: those beside each other in a row as one rectangle.
  void visit_cells(const Block& cells) {
    // Bounded: the cells of a tile.
    for (int row = cells.first_row; row < cells.last_row; ++row) {
      const auto all = field_.grid_.row(row);
      for (int column = cells.first_column; column < cells.last_column; ++column) {
        if (all[static_cast<std::size_t>(column)] == 0) continue;
        const int first = column;
        while (column < cells.last_column && all[static_cast<std::size_t>(column)] != 0) ++column;
        const Rectangle run = field_.rectangle({first, column, row, row + 1});
        if (distance_bound(run) <= nearest_.distance) consider(nearest_to_rectangle(from_, to_, run));
      }
    }
  }

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
    : grid_(grid),
      tile_columns_(tiles_for(grid.columns())),
      tile_rows_(tiles_for(grid.rows())),
      blocked_below_left_(corner(0, tile_rows_ + 1), 0) {
  // Bounded: each cell once; some milliseconds for the largest map.
  for (int row = 0; row < grid.rows(); ++row) {
    const auto cells = grid.row(row);
    for (int tile = 0; tile < tile_columns_; ++tile) {
      const std::size_t first = static_cast<std::size_t>(tile) * kTile;
      const auto in_tile = cells.subspan(first, std::min<std::size_t>(kTile, cells.size() - first));
      blocked_below_left_[corner(tile + 1, row / kTile + 1)] +=
          std::accumulate(in_tile.begin(), in_tile.end(), std::uint32_t{0});
    }
  }
  for (int row = 1; row <= tile_rows_; ++row) {
    std::uint32_t in_row = 0;
    for (int column = 1; column <= tile_columns_; ++column) {
      in_row += blocked_below_left_[corner(column, row)];
      blocked_below_left_[corner(column, row)] = blocked_below_left_[corner(column, row - 1)] + in_row;
    }
  }
}

std::optional<NearestObstacle> ObstacleField::nearest(const Position& from, const Position& to,
                                                      double reach) const {
  std::optional<NearestObstacle> nearest;
  const NearestPoint edge = nearest_edge(from, to);
  if (edge.distance < reach) nearest = NearestObstacle{edge, true};

  // Beyond the edge of the map the distance is 0; what remains is the part inside.
  const Stretch inside =
      stretch_inside(from, to, {Position(0.0, 0.0), Position(grid_.width(), grid_.height())});
  if (inside.empty() || reach <= 0.0) return nearest;
  const Position enters = inside.first > 0.0 ? Position(from + inside.first * (to - from)) : from;
  const Position leaves = inside.last < 1.0 ? Position(from + inside.last * (to - from)) : to;
  const Block around = tiles_around(enters, leaves, reach);
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
  const std::array<double, 4> starts{from.x(), grid_.width() - from.x(), from.y(), grid_.height() - from.y()};
  const std::array<double, 4> ends{to.x(), grid_.width() - to.x(), to.y(), grid_.height() - to.y()};
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

std::int64_t ObstacleField::blocked_in(const Block& tiles) const {
  return static_cast<std::int64_t>(blocked_below_left_[corner(tiles.last_column, tiles.last_row)]) -
         blocked_below_left_[corner(tiles.first_column, tiles.last_row)] -
         blocked_below_left_[corner(tiles.last_column, tiles.first_row)] +
         blocked_below_left_[corner(tiles.first_column, tiles.first_row)];
}

ObstacleField::Block ObstacleField::cells_of(const Block& tiles) const {
  return {tiles.first_column * kTile, std::min(tiles.last_column * kTile, grid_.columns()),
          tiles.first_row * kTile, std::min(tiles.last_row * kTile, grid_.rows())};
}

Rectangle ObstacleField::rectangle(const Block& cells) const {
  const double size = grid_.resolution();
  return {Position(cells.first_column * size, cells.first_row * size),
          Position(cells.last_column * size, cells.last_row * size)};
}

ObstacleField::Block ObstacleField::tiles_around(const Position& from, const Position& to,
                                                 double reach) const {
  const double size = kTile * grid_.resolution();
  const auto clamped = [size](double coordinate, int last) {
    return static_cast<int>(std::clamp(std::floor(coordinate / size), 0.0, static_cast<double>(last)));
  };
  const Position low = from.cwiseMin(to).array() - reach;
  const Position high = from.cwiseMax(to).array() + reach;
  return {clamped(low.x(), tile_columns_ - 1), clamped(high.x(), tile_columns_ - 1) + 1,
          clamped(low.y(), tile_rows_ - 1), clamped(high.y(), tile_rows_ - 1) + 1};
}

std::size_t ObstacleField::corner(int column, int row) const {
  return static_cast<std::size_t>(row) * static_cast<std::size_t>(tile_columns_ + 1) +
         static_cast<std::size_t>(column);
}

}  // namespace fleetplan::core
