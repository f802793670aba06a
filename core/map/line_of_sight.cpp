#include "core/map/line_of_sight.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/geometry/tolerance.h"

namespace fleetplan::core {
namespace {

/// Columns; the exact test of a narrower capsule is cheaper than halving it once more.
constexpr int kNarrowColumns = 4;

int floor_int(double x) { return static_cast<int>(std::floor(x)); }
/// The last cell that an open set with upper end x overlaps.
int last_cell(double x) { return static_cast<int>(std::ceil(x)) - 1; }

/// The upper boundary at abscissa x of the capsule from a to b (a.x <= b.x) of radius r.
double upper_boundary(const Position& a, const Position& b, double r, double x) {
  const Position d = b - a;
  const double length = d.norm();
  const Position normal = length > 0.0 ? Position(-d.y() / length, d.x() / length) : Position(0.0, 1.0);
  const auto arc = [&](const Position& c) {
    return c.y() + std::sqrt(std::max(0.0, r * r - (x - c.x()) * (x - c.x())));
  };
  if (d.x() <= 0.0) return arc(d.y() > 0.0 ? b : a);  // vertical, or a single disk
  if (x <= a.x() + r * normal.x()) return arc(a);
  if (x >= b.x() + r * normal.x()) return arc(b);
  return a.y() + r * normal.y() + (x - a.x() - r * normal.x()) * d.y() / d.x();
}

}  // namespace

LineOfSight::LineOfSight(const OccupancyGrid& grid)
    : columns_(grid.columns()), rows_(grid.rows()), cells_per_metre_(1.0 / grid.resolution()) {
  const auto stride = static_cast<std::size_t>(columns_) + 1;
  const auto sums = std::make_shared<std::int32_t[]>(stride * (static_cast<std::size_t>(rows_) + 1));
  for (int row = 0; row < rows_; ++row) {
    std::int32_t in_row = 0;
    for (int column = 0; column < columns_; ++column) {
      in_row += grid.blocked({column, row}) ? 1 : 0;
      const auto above = (static_cast<std::size_t>(row) + 1) * stride + static_cast<std::size_t>(column) + 1;
      sums[above] = sums[above - stride] + in_row;
    }
  }
  sums_ = sums;
}

LineOfSight::LineOfSight(const LineOfSight& walls, BlockedPolygons polygons) : LineOfSight(walls) {
  polygons_ = std::move(polygons);
}

bool LineOfSight::clears_polygons(const Position& from, const Position& to, double radius) const {
  const double reach = radius - kSearchSlack;
  return polygons_.empty() || reach <= 0.0 || !polygons_.come_near(from, to, reach);
}

std::int32_t LineOfSight::blocked_in(int column_min, int column_max, int row_min, int row_max) const {
  const auto stride = static_cast<std::size_t>(columns_) + 1;
  const auto bottom = static_cast<std::size_t>(row_min) * stride;
  const auto top = (static_cast<std::size_t>(row_max) + 1) * stride;
  const auto left = static_cast<std::size_t>(column_min);
  const auto right = static_cast<std::size_t>(column_max) + 1;
  return sums_[top + right] - sums_[top + left] - sums_[bottom + right] + sums_[bottom + left];
}

bool LineOfSight::may_sweep(const Position& from, const Position& to, double radius) const {
  const double r = std::max(0.0, radius - kSearchSlack) * cells_per_metre_;
  Capsule capsule{from * cells_per_metre_, to * cells_per_metre_, r};
  if (capsule.to.x() < capsule.from.x()) std::swap(capsule.from, capsule.to);
  const auto [low, high] = std::minmax(capsule.from.y(), capsule.to.y());
  if (capsule.from.x() < r || capsule.to.x() > columns_ - r || low < r || high > rows_ - r) return false;
  return free_of_cells(capsule) && clears_polygons(from, to, radius);
}

double LineOfSight::fitting_radius(const Position& center, double least, double most) const {
  constexpr double kMargin = 0.5e-11;  // metres; far above rounding, far below kSearchSlack
  if (disk_fits(center, most + kMargin)) return most;
  double fits = least;
  double too_large = most + kMargin;
  while (too_large - fits > kMargin) {
    const double middle = 0.5 * (fits + too_large);
    if (middle <= fits || middle >= too_large) break;  // neighbouring doubles
    (disk_fits(center, middle) ? fits : too_large) = middle;
  }
  return std::max(least, fits - kMargin);
}

bool LineOfSight::free_of_cells(const Capsule& capsule) const {
  const auto [low, high] = std::minmax(capsule.from.y(), capsule.to.y());
  const int column_min = std::max(0, floor_int(capsule.from.x() - capsule.radius));
  const int column_max = std::min(columns_ - 1, last_cell(capsule.to.x() + capsule.radius));
  const int row_min = std::max(0, floor_int(low - capsule.radius));
  const int row_max = std::min(rows_ - 1, last_cell(high + capsule.radius));
  if (blocked_in(column_min, column_max, row_min, row_max) == 0) return true;
  if (column_max - column_min < kNarrowColumns || capsule.to.x() - capsule.from.x() < kNarrowColumns) {
    return columns_free(capsule);
  }
  const Position middle = 0.5 * (capsule.from + capsule.to);
  return free_of_cells({capsule.from, middle, capsule.radius}) &&
         free_of_cells({middle, capsule.to, capsule.radius});
}

bool LineOfSight::columns_free(const Capsule& capsule) const {
  const auto& [a, b, r] = capsule;
  const double left = a.x() - r;
  const double right = b.x() + r;
  const int column_min = std::max(0, floor_int(left));
  const int column_max = std::min(columns_ - 1, last_cell(right));
  const double highest_at = b.y() >= a.y() ? b.x() : a.x();
  const double lowest_at = b.y() >= a.y() ? a.x() : b.x();
  const Position mirrored_a(a.x(), -a.y());
  const Position mirrored_b(b.x(), -b.y());
  for (int column = column_min; column <= column_max; ++column) {
    const double x_min = std::max<double>(column, left);
    const double x_max = std::min<double>(column + 1, right);
    const double top = upper_boundary(a, b, r, std::clamp(highest_at, x_min, x_max));
    const double bottom = -upper_boundary(mirrored_a, mirrored_b, r, std::clamp(lowest_at, x_min, x_max));
    const int row_min = std::max(0, floor_int(bottom));
    const int row_max = std::min(rows_ - 1, last_cell(top));
    if (row_min <= row_max && blocked_in(column, column, row_min, row_max) != 0) return false;
  }
  return true;
}

}  // namespace fleetplan::core
