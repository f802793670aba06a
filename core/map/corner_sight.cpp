#include "core/map/corner_sight.h"

#include <algorithm>
#include <cmath>

namespace fleetplan::core {
namespace {

/// Far beyond any map, in cells, and still exact as a difference of integers.
constexpr int kFar = 1 << 28;
/// Any direction; finite, so that times zero is zero.
constexpr double kSteepest = 1e18;
/// Rounding of places where lines of sight cross a row, in cells; generous, as too much sight does no harm.
constexpr double kBlur = 1e-7;

std::optional<Corner> convex_corner(const OccupancyGrid& grid, int x, int line) {
  std::optional<Corner> corner;
  for (const int away_x : {1, -1}) {
    for (const int away_y : {1, -1}) {
      const Cell behind{away_x > 0 ? x - 1 : x, away_y > 0 ? line - 1 : line};
      if (!grid.blocked(behind)) continue;
      if (corner) return std::nullopt;
      corner = Corner{x, line, away_x, away_y};
    }
  }
  return corner;
}

}  // namespace

CornerSight::CornerSight(const OccupancyGrid& grid) : grid_(grid) {
  for (int line = 0; line <= grid.rows(); ++line) {
    lines_.push_back(count());
    for (int x = 0; x <= grid.columns(); ++x) {
      const auto corner = convex_corner(grid, x, line);
      if (!corner) continue;
      corners_.push_back(*corner);
      abscissae_.push_back(x);
    }
  }
  lines_.push_back(count());
  for (int row = 0; row < grid.rows(); ++row) {
    rows_.push_back(static_cast<int>(runs_.size()));
    runs_.push_back({-kFar, 0});
    for (int column = 0; column < grid.columns(); ++column) {
      if (!grid.blocked({column, row})) continue;
      if (runs_.back().end == column) {
        ++runs_.back().end;
      } else {
        runs_.push_back({column, column + 1});
      }
    }
    if (runs_.back().end == grid.columns()) {
      runs_.back().end = kFar;
    } else {
      runs_.push_back({grid.columns(), kFar});
    }
  }
  rows_.push_back(static_cast<int>(runs_.size()));
  from_corner_.resize(corners_.size());
}

Position CornerSight::position(int index) const {
  return grid_.resolution() * Position(corner(index).x, corner(index).y);
}

std::vector<int> CornerSight::seen_from(const Position& position) const {
  return seen(position.x() / grid_.resolution(), position.y() / grid_.resolution());
}

const std::vector<int>& CornerSight::seen_from_corner(int index) {
  auto& known = from_corner_[static_cast<std::size_t>(index)];
  if (!known) known = seen(corner(index).x, corner(index).y);
  return *known;
}

std::vector<int> CornerSight::seen(double x, double y) const {
  std::vector<int> found;
  scan(x, y, true, found);
  scan(x, y, false, found);
  const double line = std::round(y);
  if (std::abs(y - line) <= kBlur) look_along(x, static_cast<int>(line), found);
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

void CornerSight::scan(double x, double y, bool up, std::vector<int>& found) const {
  std::vector<Fan> fans{{-kSteepest, kSteepest}};
  const int step = up ? 1 : -1;
  int row = static_cast<int>(up ? std::floor(y) : std::ceil(y) - 1.0);
  for (; row >= 0 && row < grid_.rows() && !fans.empty(); row += step) {
    const double near = std::max(0.0, up ? row - y : y - (row + 1));
    const double far = up ? row + 1 - y : y - row;
    fans = through_row(fans, x, row, near, far);
    find_on_line(fans, x, up ? row + 1 : row, far, found);
  }
}

/// What the blocked runs of a row, between `near` and `far` from the viewpoint, leave of the fans.
std::vector<CornerSight::Fan> CornerSight::through_row(const std::vector<Fan>& fans, double x, int row,
                                                       double near, double far) const {
  const auto first = runs_.begin() + rows_[static_cast<std::size_t>(row)];
  const auto last = runs_.begin() + rows_[static_cast<std::size_t>(row) + 1];
  std::vector<Fan> left_over;
  for (const Fan& fan : fans) {
    double open = fan.left;
    const double leftmost = x + std::min(fan.left * near, fan.left * far) - kBlur;
    auto run = std::lower_bound(
        first, last, leftmost, [](const Run& r, double value) { return static_cast<double>(r.end) < value; });
    for (; run != last && open <= fan.right; ++run) {
      const double a = run->begin - x;
      const double b = run->end - x;
      const double hidden_from = a >= 0.0 ? a / far : (near > 0.0 ? a / near : -kSteepest);
      const double hidden_to = b <= 0.0 ? b / far : (near > 0.0 ? b / near : kSteepest);
      if (hidden_from > fan.right) break;
      if (hidden_from >= open) left_over.push_back({open, hidden_from});
      open = std::max(open, hidden_to);
    }
    if (open <= fan.right) left_over.push_back({open, fan.right});
  }
  return left_over;
}

void CornerSight::find_on_line(const std::vector<Fan>& fans, double x, int line, double distance,
                               std::vector<int>& found) const {
  const auto begin = abscissae_.begin();
  const auto last = begin + lines_[static_cast<std::size_t>(line) + 1];
  auto next = begin + lines_[static_cast<std::size_t>(line)];
  for (const Fan& fan : fans) {
    next = std::lower_bound(next, last, x + fan.left * distance - kBlur);
    const double rightmost = x + fan.right * distance + kBlur;
    for (; next != last && *next <= rightmost; ++next) found.push_back(static_cast<int>(next - begin));
  }
}

void CornerSight::look_along(double x, int line, std::vector<int>& found) const {
  const auto open = [&](int column) {
    return !grid_.blocked({column, line}) || !grid_.blocked({column, line - 1});
  };
  const auto take = [&](int abscissa) {
    if (const auto corner = corner_at(abscissa, line)) found.push_back(*corner);
  };
  for (int column = static_cast<int>(std::floor(x)); open(column); ++column) take(column + 1);
  for (int column = static_cast<int>(std::ceil(x)) - 1; open(column); --column) take(column);
}

std::optional<int> CornerSight::corner_at(int x, int line) const {
  const auto first = abscissae_.begin() + lines_[static_cast<std::size_t>(line)];
  const auto last = abscissae_.begin() + lines_[static_cast<std::size_t>(line) + 1];
  const auto at = std::lower_bound(first, last, x);
  if (at == last || *at != x) return std::nullopt;
  return static_cast<int>(at - abscissae_.begin());
}

}  // namespace fleetplan::core
