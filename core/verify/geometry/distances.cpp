#include "core/verify/geometry/distances.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

namespace fleetplan::core {

namespace {

double distance_to_rectangle(const Position& point, const Rectangle& rectangle) {
  const double dx = std::max({rectangle.low.x() - point.x(), point.x() - rectangle.high.x(), 0.0});
  const double dy = std::max({rectangle.low.y() - point.y(), point.y() - rectangle.high.y(), 0.0});
  return std::sqrt(dx * dx + dy * dy);
}

NearestPoint nearest_to_point(const Position& from, const Position& to, const Position& point) {
  const Position way = to - from;
  const double fraction = std::clamp((point - from).dot(way) / way.squaredNorm(), 0.0, 1.0);
  return {(from + fraction * way - point).norm(), fraction};
}

NearestPoint nearer_or_earlier(const NearestPoint& a, const NearestPoint& b) {
  if (a.distance != b.distance) return a.distance < b.distance ? a : b;
  return a.fraction <= b.fraction ? a : b;
}

/// Returns the part of `stretch` whose coordinate, linear from `from` to `to`, is between `low` and `high`.
Stretch narrowed(const Stretch& stretch, double from, double to, double low, double high) {
  const double way = to - from;
  if (way == 0.0) return from < low || from > high ? Stretch{1.0, 0.0} : stretch;
  const double at_low = (low - from) / way;
  const double at_high = (high - from) / way;
  return {std::max(stretch.first, std::min(at_low, at_high)),
          std::min(stretch.last, std::max(at_low, at_high))};
}

}  // namespace

Stretch stretch_inside(const Position& from, const Position& to, const Rectangle& rectangle) {
  const Stretch in_x = narrowed({}, from.x(), to.x(), rectangle.low.x(), rectangle.high.x());
  return narrowed(in_x, from.y(), to.y(), rectangle.low.y(), rectangle.high.y());
}

NearestPoint nearest_to_rectangle(const Position& from, const Position& to, const Rectangle& rectangle) {
  const NearestPoint at_start{distance_to_rectangle(from, rectangle), 0.0};
  if ((to - from).squaredNorm() <= 0.0) return at_start;
  const Stretch inside = stretch_inside(from, to, rectangle);
  if (!inside.empty()) return {0.0, inside.first};

  // If two convex shapes are disjoint, a corner of one of them has their distance from the other shape.
  const NearestPoint at_end{distance_to_rectangle(to, rectangle), 1.0};
  NearestPoint nearest = nearer_or_earlier(at_start, at_end);
  const auto [left, bottom] = std::pair{rectangle.low.x(), rectangle.low.y()};
  const auto [right, top] = std::pair{rectangle.high.x(), rectangle.high.y()};
  for (const Position& corner :
       {Position(left, bottom), Position(right, bottom), Position(left, top), Position(right, top)}) {
    nearest = nearer_or_earlier(nearest, nearest_to_point(from, to, corner));
  }
  return nearest;
}

namespace {

double perp_dot(const Position& a, const Position& b) { return a.x() * b.y() - a.y() * b.x(); }

const Position& next_corner(const std::vector<Position>& corners, std::size_t k) {
  return corners[(k + 1) % corners.size()];
}

/// Returns the fraction of a segment at which it is nearest to a point.
double nearest_fraction(const Position& point, const Position& from, const Position& to) {
  const Position d = to - from;
  const double squared = d.squaredNorm();
  return squared > 0.0 ? std::clamp(d.dot(point - from) / squared, 0.0, 1.0) : 0.0;
}

double distance_from_edge(const Position& point, const Position& a, const Position& b) {
  return (a + nearest_fraction(point, a, b) * (b - a) - point).norm();
}

double distance_from_border(const std::vector<Position>& corners, const Position& point) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < corners.size(); ++k) {
    least = std::min(least, distance_from_edge(point, corners[k], next_corner(corners, k)));
  }
  return least;
}

/// Returns the fraction of the segment at which it crosses an edge; none if they are parallel or do not meet.
std::optional<double> crossing(const Position& from, const Position& to, const Position& a,
                               const Position& b) {
  const Position along = to - from;
  const Position edge = b - a;
  const double turn = perp_dot(along, edge);
  if (turn == 0.0) return std::nullopt;
  const double at = perp_dot(a - from, edge) / turn;
  const double on_edge = perp_dot(a - from, along) / turn;
  if (at < 0.0 || at > 1.0 || on_edge < 0.0 || on_edge > 1.0) return std::nullopt;
  return at;
}

/// Returns the nearest point of the segment to an edge of the border.
NearestPoint nearest_to_edge(const Position& from, const Position& to, const Position& a, const Position& b) {
  if (const auto at = crossing(from, to, a, b)) return {0.0, *at};
  NearestPoint nearest{distance_from_edge(from, a, b), 0.0};
  const auto consider = [&](double distance, double fraction) {
    if (distance < nearest.distance || (distance == nearest.distance && fraction < nearest.fraction)) {
      nearest = {distance, fraction};
    }
  };
  consider(distance_from_edge(to, a, b), 1.0);
  for (const Position* end : {&a, &b}) {
    const double fraction = nearest_fraction(*end, from, to);
    consider((from + fraction * (to - from) - *end).norm(), fraction);
  }
  return nearest;
}

}  // namespace

bool is_inside(const std::vector<Position>& corners, const Position& point) {
  int winding = 0;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const Position a = corners[k] - point;
    const Position b = next_corner(corners, k) - point;
    if (a.y() <= 0.0 && b.y() > 0.0 && perp_dot(a, b) > 0.0) ++winding;
    if (a.y() > 0.0 && b.y() <= 0.0 && perp_dot(a, b) < 0.0) --winding;
  }
  return winding != 0;
}

bool is_deep_inside(const std::vector<Position>& corners, const Position& point, double depth) {
  return is_inside(corners, point) && distance_from_border(corners, point) > depth;
}

NearestPoint nearest_to_polygon(const Position& from, const Position& to,
                                const std::vector<Position>& corners) {
  if (is_inside(corners, from)) return {0.0, 0.0};
  NearestPoint nearest{std::numeric_limits<double>::infinity(), 0.0};
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const NearestPoint found = nearest_to_edge(from, to, corners[k], next_corner(corners, k));
    const bool is_nearer = found.distance < nearest.distance;
    if (is_nearer || (found.distance == nearest.distance && found.fraction < nearest.fraction)) {
      nearest = found;
    }
  }
  return nearest;
}

std::vector<Stretch> stretches_inside(const Position& from, const Position& to,
                                      const std::vector<Position>& corners, double depth,
                                      const StopCondition& stop) {
  std::vector<double> ends{0.0, 1.0};
  for (std::size_t k = 0; k < corners.size(); ++k) {
    // The stretches end at crossings, and at the ends of edges that the segment passes along.
    if (const auto at = crossing(from, to, corners[k], next_corner(corners, k))) ends.push_back(*at);
    ends.push_back(nearest_fraction(corners[k], from, to));
  }
  std::sort(ends.begin(), ends.end());
  std::vector<Stretch> inside;
  for (std::size_t k = 0; k + 1 < ends.size() && !stop.met(); ++k) {
    const double length = ends[k + 1] - ends[k];
    if (length <= 0.0) continue;
    bool is_deep = false;
    bool all_inside = true;
    for (const double quarter : {0.25, 0.5, 0.75}) {
      const Position point = from + (ends[k] + quarter * length) * (to - from);
      all_inside = all_inside && is_inside(corners, point);
      is_deep = is_deep || (all_inside && distance_from_border(corners, point) > depth);
    }
    if (!all_inside || !is_deep) continue;
    if (!inside.empty() && inside.back().last == ends[k]) {
      inside.back().last = ends[k + 1];
    } else {
      inside.push_back({ends[k], ends[k + 1]});
    }
  }
  return inside;
}

namespace {

/// The cells of a map are counted in square tiles with sides of so many. Smaller ones cost memory and time
/// for maps, larger ones time for segments.
constexpr int kTile = 8;

int tiles_for(int cells) { return (cells + kTile - 1) / kTile; }

}  // namespace

/// Branch and bound for the blocked cell nearest to a segment. Blocks of tiles are halved until they are all
/// free, all blocked, or one tile. They are dropped if they are too far away.
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
    // The nearer half comes first, because its result may exclude the other half.
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
  /// Looks at the blocked cells one by one. Cells beside each other in a row count as one rectangle.
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
