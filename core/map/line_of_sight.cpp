#include "core/map/line_of_sight.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/geometry/segment.h"
#include "core/geometry/tolerance.h"

namespace fleetplan::core {
namespace {

constexpr int kBand = 64;  // rows
/// The radius, in cells, from which on squares of kBand x kBand cells are looked at before cells.
constexpr double kLargeDisk = 128.0;

int bands(int cells) { return (cells + kBand - 1) / kBand; }
/// The difference, in cells, below which cases are left to the exact test: far above the rounding of
/// positions.
constexpr double kBoundsRounding = 1e-7;
/// The shortest step along a move, in cells, that is worth its cost; otherwise the exact test decides about
/// the next kStepInDoubt cells.
constexpr double kShortestStep = 0.5;
constexpr double kStepInDoubt = 2.0;
/// The next point of a move that is examined is farther than the part known to be clear, by this share of the
/// last point's clear distance. Usually, the clear disks of both points meet.
constexpr double kRelaxation = 0.8;
/// The radius, in cells, below which disks are tested in rectangles of cells. Such disks fit in places where
/// the bounds do not tell.
constexpr double kSmallDisk = 3.0;
/// The number of columns up to which the exact test of a capsule is cheaper than halving it once more.
constexpr int kNarrowColumns = 4;
/// The most words that are looked at for one rectangle.
constexpr int kMaxWords = 64;
/// The distance, in cells, from the centre of a cell to its corners, rounded up, and to its sides.
constexpr double kToCorner = 0.7072;
constexpr double kToSide = 0.5;

int floor_int(double x) { return static_cast<int>(std::floor(x)); }
/// Returns the last cell that an open set with upper end x overlaps.
int last_cell(double x) { return static_cast<int>(std::ceil(x)) - 1; }

/// The upper boundary of the capsule from a to b (a.x <= b.x) of radius r.
class UpperBoundary {
 public:
  UpperBoundary(const Position& a, const Position& b, double r) : a_(a), b_(b), r_(r) {
    const Position d = b - a;
    if (d.x() <= 0.0) {  // vertical, or a single disk
      if (d.y() > 0.0) a_ = b;
      b_ = a_;
      return;
    }
    const double length = d.norm();
    line_begin_ = a + r / length * Position(-d.y(), d.x());
    line_end_ = line_begin_.x() + d.x();
    slope_ = d.y() / d.x();
  }

  double at(double x) const {
    if (x <= line_begin_.x()) return arc(a_, x);
    if (x >= line_end_) return arc(b_, x);
    return line_begin_.y() + (x - line_begin_.x()) * slope_;
  }

 private:
  double arc(const Position& center, double x) const {
    return center.y() + std::sqrt(std::max(0.0, r_ * r_ - (x - center.x()) * (x - center.x())));
  }

  Position a_;
  Position b_;
  double r_;
  Position line_begin_{kForever, 0.0};
  double line_end_ = kForever;
  double slope_ = 0.0;
};

}  // namespace

LineOfSight::Cells::Cells(const OccupancyGrid& grid, const StopCondition& stop)
    : distances(grid, stop),
      blocked(static_cast<std::size_t>(bands(grid.rows())) * static_cast<std::size_t>(grid.columns())),
      blocked_squares(static_cast<std::size_t>(bands(grid.rows())) *
                      static_cast<std::size_t>(bands(grid.columns()))) {
  if (!distances.finished()) return;
  StopStride stride = StopStride::from_first(stop, kBand);
  for (int row = 0; row < grid.rows(); ++row) {
    if (stride.met_at_step()) return;
    std::uint64_t* band =
        &blocked[static_cast<std::size_t>(row / kBand) * static_cast<std::size_t>(grid.columns())];
    for (int column = 0; column < grid.columns(); ++column) {
      band[column] |= std::uint64_t{grid.blocked({column, row})} << static_cast<unsigned>(row % kBand);
    }
  }
  std::size_t square = 0;
  for (auto band = blocked.begin(); band != blocked.end(); band += grid.columns()) {
    for (int column = 0; column < grid.columns(); column += kBand) {
      const int end = std::min(column + kBand, grid.columns());
      blocked_squares[square++] =
          std::any_of(band + column, band + end, [](std::uint64_t rows) { return rows != 0; });
    }
  }
  finished = true;
}

LineOfSight::LineOfSight(const OccupancyGrid& grid, const StopCondition& stop)
    : columns_(grid.columns()),
      rows_(grid.rows()),
      cells_per_metre_(1.0 / grid.resolution()),
      cells_(std::make_shared<const Cells>(grid, stop)) {}

LineOfSight::LineOfSight(const LineOfSight& walls, BlockedPolygons polygons)
    : columns_(walls.columns_),
      rows_(walls.rows_),
      cells_per_metre_(walls.cells_per_metre_),
      cells_(walls.cells_),
      polygons_(std::move(polygons)) {}

std::size_t LineOfSight::bytes() const {
  return cells_->distances.bytes() + cells_->blocked.capacity() * sizeof(std::uint64_t) +
         cells_->blocked_squares.capacity();
}

bool LineOfSight::clears_polygons(const Position& from, const Position& to, double radius) const {
  const double reach = radius - kSearchSlack;
  return polygons_.empty() || reach <= 0.0 || !polygons_.come_near(from, to, reach);
}

bool LineOfSight::is_blocked(int column, int row_min, int row_max) const {
  const auto first = static_cast<std::size_t>(row_min / kBand);
  const auto last = static_cast<std::size_t>(row_max / kBand);
  for (std::size_t band = first; band <= last; ++band) {
    std::uint64_t rows = ~std::uint64_t{0};
    if (band == first) rows <<= static_cast<unsigned>(row_min % kBand);
    if (band == last) rows &= ~std::uint64_t{0} >> static_cast<unsigned>(kBand - 1 - row_max % kBand);
    if ((cells_->blocked[band * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(column)] &
         rows) != 0) {
      return true;
    }
  }
  return false;
}

bool LineOfSight::squares_free(int column, int row_min, int row_max) const {
  for (int band = row_min / kBand; band <= row_max / kBand; ++band) {
    const int square = band * bands(columns_) + column / kBand;
    if (cells_->blocked_squares[static_cast<std::size_t>(square)] != 0) return false;
  }
  return true;
}

bool LineOfSight::may_sweep(const Position& from, const Position& to, double radius) const {
  const double r = std::max(0.0, radius - kSearchSlack) * cells_per_metre_;
  Capsule capsule{from * cells_per_metre_, to * cells_per_metre_, r};
  if (capsule.to.x() < capsule.from.x()) std::swap(capsule.from, capsule.to);
  const auto [low, high] = std::minmax(capsule.from.y(), capsule.to.y());
  if (capsule.from.x() < r || capsule.to.x() > columns_ - r || low < r || high > rows_ - r) return false;
  const bool is_free = r < kSmallDisk ? rectangles_free(capsule) : free_of_cells(capsule);
  return is_free && clears_polygons(from, to, radius);
}

double LineOfSight::fitting_radius(const Position& center, double least, double max) const {
  constexpr double kMargin = 0.5e-11;  // metres; far above rounding, far below kSearchSlack
  if (disk_fits(center, max + kMargin)) return max;
  double fits = least;
  double too_large = max + kMargin;
  while (too_large - fits > kMargin) {
    const double middle = 0.5 * (fits + too_large);
    if (middle <= fits || middle >= too_large) break;  // neighbouring doubles
    (disk_fits(center, middle) ? fits : too_large) = middle;
  }
  return std::max(least, fits - kMargin);
}

/// Returns the bounds for a point on the map, from the transform's distances between centres of cells.
LineOfSight::Bounds LineOfSight::distance_from_cells(const Position& point) const {
  const int column = std::min(columns_ - 1, static_cast<int>(point.x()));
  const int row = std::min(rows_ - 1, static_cast<int>(point.y()));
  const int squared = cells_->distances.squared({column, row});
  if (squared == 0) return {0.0, 0.0};
  const double off_x = point.x() - column - kToSide;
  const double off_y = point.y() - row - kToSide;
  const double off_center = std::sqrt(off_x * off_x + off_y * off_y);
  const double distance = std::sqrt(static_cast<double>(squared));
  return {distance - kToCorner - off_center,
          squared < DistanceTransform::kMaxSquared ? distance - kToSide + off_center : kForever};
}

bool LineOfSight::free_of_cells(const Capsule& capsule) const {
  const Position displacement = capsule.to - capsule.from;
  const double length = displacement.norm();
  const Position step = length > 0.0 ? Position(displacement / length) : displacement;
  const auto free_between = [&](double begin, double end) {
    const Position to = end < length ? Position(capsule.from + end * step) : capsule.to;
    return columns_free({capsule.from + begin * step, to, capsule.radius});
  };
  double followed = 0.0;       // distance to which the move is followed
  double in_doubt_from = 0.0;  // distance to which it is clear
  double at = 0.0;             // distance to look at next, at least `followed`
  do {
    const Bounds distance = distance_from_cells(capsule.from + at * step);
    if (distance.most < capsule.radius - kBoundsRounding) return false;
    const double clear = distance.least - capsule.radius - kBoundsRounding;
    if (clear >= kShortestStep && at - clear <= followed) {
      if (at - clear > in_doubt_from && in_doubt_from < followed &&
          !free_between(in_doubt_from, at - clear)) {
        return false;
      }
      in_doubt_from = followed = at + clear;
      at = std::min(followed + kRelaxation * clear, length);
    } else {
      if (at <= followed) followed = at + kStepInDoubt;
      at = followed;
    }
  } while (followed < length);
  return in_doubt_from >= followed || free_between(in_doubt_from, length);
}

bool LineOfSight::rectangles_free(const Capsule& capsule) const {
  const auto [low, high] = std::minmax(capsule.from.y(), capsule.to.y());
  const int column_min = std::max(0, floor_int(capsule.from.x() - capsule.radius));
  const int column_max = std::min(columns_ - 1, last_cell(capsule.to.x() + capsule.radius));
  const int row_min = std::max(0, floor_int(low - capsule.radius));
  const int row_max = std::min(rows_ - 1, last_cell(high + capsule.radius));
  const int bands = row_max / kBand - row_min / kBand + 1;
  if ((column_max - column_min + 1) * bands <= kMaxWords) {
    int column = column_min;
    while (column <= column_max && !is_blocked(column, row_min, row_max)) ++column;
    if (column > column_max) return true;
  }
  if (column_max - column_min < kNarrowColumns || capsule.to.x() - capsule.from.x() < kNarrowColumns) {
    return columns_free(capsule);
  }
  const Position middle = 0.5 * (capsule.from + capsule.to);
  return rectangles_free({capsule.from, middle, capsule.radius}) &&
         rectangles_free({middle, capsule.to, capsule.radius});
}

double LineOfSight::surely_free(const Position& center, double radius) const {
  const Position point = center * cells_per_metre_;
  if (point.x() < 0.0 || point.y() < 0.0 || point.x() > columns_ || point.y() > rows_) return -kForever;
  const double from_cells = (distance_from_cells(point).least - kBoundsRounding) / cells_per_metre_;
  return clears_polygons(center, center, from_cells) ? from_cells - radius : -kForever;
}

double LineOfSight::surely_blocked(const Position& center, double radius) const {
  const Position point = center * cells_per_metre_;
  if (point.x() < 0.0 || point.y() < 0.0 || point.x() > columns_ || point.y() > rows_) return -kForever;
  return radius - kSearchSlack - (distance_from_cells(point).most + kBoundsRounding) / cells_per_metre_;
}

bool LineOfSight::columns_free(const Capsule& capsule) const {
  const auto& [a, b, r] = capsule;
  const double left = a.x() - r;
  const double right = b.x() + r;
  const int column_min = std::max(0, floor_int(left));
  const int column_max = std::min(columns_ - 1, last_cell(right));
  const double highest_at = b.y() >= a.y() ? b.x() : a.x();
  const double lowest_at = b.y() >= a.y() ? a.x() : b.x();
  const UpperBoundary above(a, b, r);
  const UpperBoundary below({a.x(), -a.y()}, {b.x(), -b.y()}, r);
  // Returns the first and the last row that the capsule overlaps in so many columns.
  const auto rows_of = [&](int column, int columns) {
    const double x_min = std::max<double>(column, left);
    const double x_max = std::min<double>(column + columns, right);
    const double top = above.at(std::clamp(highest_at, x_min, x_max));
    const double bottom = -below.at(std::clamp(lowest_at, x_min, x_max));
    return std::pair(std::max(0, floor_int(bottom)), std::min(rows_ - 1, last_cell(top)));
  };
  for (int column = column_min; column <= column_max; ++column) {
    if (r > kLargeDisk && column % kBand == 0) {
      const auto [first, last] = rows_of(column, kBand);
      if (squares_free(column, first, last)) {
        column += kBand - 1;
        continue;
      }
    }
    const auto [row_min, row_max] = rows_of(column, 1);
    if (row_min <= row_max && is_blocked(column, row_min, row_max)) return false;
  }
  return true;
}

}  // namespace fleetplan::core
