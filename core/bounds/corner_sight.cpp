#include "core/bounds/corner_sight.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace fleetplan::core {
namespace {

/// Far beyond any map, in cells, and still exact as a difference of integers.
constexpr int kFar = 1 << 28;
/// Any direction; finite, so that times zero is zero.
constexpr double kSteepest = 1e18;
/// Rounding of places where lines of sight cross a row, in cells; generous, as too much sight does no harm.
constexpr double kBlur = 1e-7;

/// The test for fans that are too narrow begins at so many radii from the viewpoint; asin(2 / kRadiiAhead) is
/// at most kAsin times its argument.
constexpr double kRadiiAhead = 4.0;
constexpr double kAsin = 1.05;
/// Room for disks a little smaller than told, and for rounding.
constexpr double kSnug = 0.99;

/// Work to follow a fan through a row; measured.
constexpr int kFanWork = 2;

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

/// What is seen from one point, row by row: the directions that nothing hides so far are fans.
class CornerSight::View {
 public:
  View(const CornerSight& sight, double x, double y) : sight_(sight), x_(x), y_(y) {}

  /// All of them, or all that tangents lead to from bends around this corner (where the viewpoint is).
  std::vector<int> corners(const Corner* bend) {
    const int right_above = bend == nullptr ? 0 : -bend->away_x * bend->away_y;
    scan(true, right_above);
    scan(false, -right_above);
    const double line = std::round(y_);
    if (std::abs(y_ - line) <= kBlur) look_along(static_cast<int>(line));
    std::sort(found_.begin(), found_.end());
    found_.erase(std::unique(found_.begin(), found_.end()), found_.end());
    return std::move(found_);
  }
  std::int64_t fans_followed() const { return fans_followed_; }

 private:
  struct Fan {  // directions dx / dy, closed
    double left;
    double right;
  };

  /// Rows above (`up`) or below. `side`: 1 to look for tangents that lead to the right, -1 to the left, 0 for
  /// all corners. The places that a tangent touches are up to a diameter nearer together, in either
  /// direction, than the corners.
  void scan(bool up, int side) {
    const double diameter = 2.0 * sight_.most_ + kBlur;
    const int step = up ? 1 : -1;
    fans_ = {{-kSteepest, kSteepest}};
    int row = static_cast<int>(up ? std::floor(y_) : std::ceil(y_) - 1.0);
    for (; row >= 0 && row < sight_.grid_.rows() && !fans_.empty(); row += step) {
      const double near = std::max(0.0, up ? row - y_ : y_ - (row + 1));
      const double far = up ? row + 1 - y_ : y_ - row;
      if (side != 0 && far > diameter) look_aside(side, diameter / far);
      pass_row(row, near, far);
      find_on_line(up ? row + 1 : row, far);
    }
  }

  /// Takes from the fans all but one side, with a margin.
  void look_aside(int side, double margin) {
    for (Fan& fan : fans_) {
      if (side > 0) {
        fan.left = std::max(fan.left, -margin);
      } else {
        fan.right = std::min(fan.right, margin);
      }
    }
  }

  /// Takes from the fans what the blocked runs of a row, between `near` and `far` from the viewpoint, hide.
  void pass_row(int row, double near, double far) {
    fans_followed_ += static_cast<std::int64_t>(fans_.size());
    left_over_.clear();
    const auto last = sight_.runs_.begin() + sight_.rows_[static_cast<std::size_t>(row) + 1];
    auto first = sight_.runs_.begin() + sight_.rows_[static_cast<std::size_t>(row)];
    for (const Fan& fan : fans_) {
      double open = fan.left;
      const double leftmost = x_ + std::min(fan.left * near, fan.left * far) - kBlur;
      while (first + 1 != last && first->end < leftmost) ++first;
      for (auto run = first; run != last && open <= fan.right; ++run) {
        const double a = run->begin - x_;
        const double b = run->end - x_;
        const double hidden_from = a >= 0.0 ? a / far : (near > 0.0 ? a / near : -kSteepest);
        const double hidden_to = b <= 0.0 ? b / far : (near > 0.0 ? b / near : kSteepest);
        if (hidden_from > fan.right) break;
        keep({open, hidden_from}, far);
        open = std::max(open, hidden_to);
      }
      keep({open, fan.right}, far);
    }
    std::swap(fans_, left_over_);
  }

  void keep(const Fan& fan, double distance) {
    if (fan.left < fan.right && !too_narrow(fan, distance)) left_over_.push_back(fan);
  }

  /// Is the fan at this distance (rows) from the viewpoint too narrow for any move to a corner in it, there
  /// or farther on? What the disk covers on its way is convex, so on no grid line between its ends does it
  /// cover less than on one of theirs, and there at least a chord of the disk: 2 r sin(phi), if it moves at
  /// an angle phi to the lines. The line to the corner differs from that by no more than asin(2 r / d), d its
  /// length.
  bool too_narrow(const Fan& fan, double distance) const {
    const double radius = sight_.least_;
    if (distance < kRadiiAhead * radius) return false;
    const double slope = std::max(std::abs(fan.left), std::abs(fan.right));
    const double chord = 2.0 * radius / std::sqrt(1.0 + slope * slope);
    return (fan.right - fan.left) * distance < kSnug * chord * (1.0 - kAsin * 2.0 * radius / distance);
  }

  void find_on_line(int line, double distance) {
    const int last = sight_.first_corner(0, line + 1);
    int next = 0;
    for (const Fan& fan : fans_) {
      const double leftmost = std::ceil(x_ + fan.left * distance - kBlur);
      if (leftmost > sight_.grid_.columns()) return;
      const double rightmost = x_ + fan.right * distance + kBlur;
      next = std::max(next, sight_.first_corner(static_cast<int>(std::max(0.0, leftmost)), line));
      for (; next != last && sight_.corner(next).x <= rightmost; ++next) found_.push_back(next);
    }
  }

  /// Along the grid line on which the viewpoint lies.
  void look_along(int line) {
    const OccupancyGrid& grid = sight_.grid_;
    const auto open = [&](int column) {
      return !grid.blocked({column, line}) || !grid.blocked({column, line - 1});
    };
    const auto take = [&](int x) {
      const int first = sight_.first_corner(x, line);
      if (first != sight_.first_corner(x + 1, line)) found_.push_back(first);
    };
    for (int column = static_cast<int>(std::floor(x_)); open(column); ++column) take(column + 1);
    for (int column = static_cast<int>(std::ceil(x_)) - 1; open(column); --column) take(column);
  }

  const CornerSight& sight_;
  double x_;  // in cells
  double y_;
  std::vector<Fan> fans_;
  std::vector<Fan> left_over_;
  std::vector<int> found_;
  std::int64_t fans_followed_ = 0;
};

CornerSight::CornerSight(const OccupancyGrid& grid, double least, double most)
    : grid_(grid), least_(least / grid.resolution()), most_(most / grid.resolution()) {
  for (int line = 0; line <= grid.rows(); ++line) {
    for (int x = 0; x <= grid.columns(); ++x) {
      before_.push_back(count());
      const auto corner = convex_corner(grid, x, line);
      if (corner) corners_.push_back(*corner);
    }
  }
  before_.push_back(count());
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

std::vector<int> CornerSight::seen_from(const Position& position) {
  return seen(position.x() / grid_.resolution(), position.y() / grid_.resolution(), nullptr);
}

const std::vector<int>& CornerSight::bends_from(int index) {
  auto& known = from_corner_[static_cast<std::size_t>(index)];
  if (!known) known = seen(corner(index).x, corner(index).y, &corner(index));
  return *known;
}

std::vector<int> CornerSight::seen(double x, double y, const Corner* bend) {
  View view(*this, x, y);
  std::vector<int> corners = view.corners(bend);
  work_ += kFanWork * view.fans_followed() + static_cast<std::int64_t>(corners.size());
  return corners;
}

int CornerSight::first_corner(int x, int line) const {
  const auto columns = static_cast<std::size_t>(grid_.columns()) + 1;
  return before_[static_cast<std::size_t>(line) * columns + static_cast<std::size_t>(x)];
}

}  // namespace fleetplan::core
