#include "core/bounds/corner_visibility.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <utility>

namespace fleetplan::core {
namespace {

/// Far beyond any map, in cells, and still exact as a difference of integers.
constexpr int kFar = 1 << 28;
/// Steeper than any direction that matters; finite, so that its product with zero is zero.
constexpr double kSteepest = 1e18;
/// Rounding of positions where lines of sight cross a row, in cells; generous, as too many corners do no
/// harm.
constexpr double kRounding = 1e-7;

/// The distance from the viewpoint, in radii, from which on narrow sectors are dropped; asin(2 / kMinRadii)
/// is at most kAsinFactor times its argument.
constexpr double kMinRadii = 4.0;
constexpr double kAsinFactor = 1.05;
/// A margin for disks slightly smaller than the given radius, and for rounding.
constexpr double kWidthMargin = 0.99;

/// The work of following a sector through a row; measured.
constexpr int kSectorWork = 2;

/// Rows, or corners, between two checks of the stop condition.
constexpr std::size_t kStopStride = 16;

/// The corner at a grid point with one blocked cell around it.
Corner convex_corner(const OccupancyGrid& grid, int x, int line) {
  const bool is_left = grid.blocked({x - 1, line - 1}) || grid.blocked({x - 1, line});
  const bool is_below = grid.blocked({x - 1, line - 1}) || grid.blocked({x, line - 1});
  return {x, line, is_left ? 1 : -1, is_below ? 1 : -1};
}

/// Calls visit(index) for each byte of this value.
template <class Visitor>
void for_each_equal(const std::vector<std::uint8_t>& bytes, int value, Visitor&& visit) {
  const std::uint8_t* const first = bytes.data();
  const std::uint8_t* const last = first + bytes.size();
  const std::uint8_t* at = first;
  while (at != last) {
    at = static_cast<const std::uint8_t*>(std::memchr(at, value, static_cast<std::size_t>(last - at)));
    if (at == nullptr) return;
    visit(static_cast<int>(at - first));
    ++at;
  }
}

}  // namespace

/// Finds the corners visible from one point, row by row. Directions that no cell hides so far form sectors.
class CornerVisibility::View {
 public:
  View(CornerVisibility& corners, double x, double y) : corners_(corners), x_(x), y_(y) {}

  /// Returns the corners visible from the viewpoint, ascending. With `bend`, the corner at the viewpoint,
  /// returns only corners to which tangents lead from its bends.
  std::vector<int> find(const Corner* bend) {
    const int right_above = bend == nullptr ? 0 : -bend->away_x * bend->away_y;
    scan(true, right_above);
    scan(false, -right_above);
    const double line = std::round(y_);
    if (std::abs(y_ - line) <= kRounding) scan_line(static_cast<int>(line));
    std::sort(found_.begin(), found_.end());
    found_.erase(std::unique(found_.begin(), found_.end()), found_.end());
    return std::move(found_);
  }
  std::int64_t sectors_followed() const { return sectors_followed_; }

 private:
  struct Sector {  // directions dx / dy, closed
    double left;
    double right;
  };

  /// Scans the rows above (`up`) or below. `side`: 1 for tangents that lead to the right, -1 to the left, 0
  /// for all corners. The points that a tangent touches are up to a diameter nearer to each other, in either
  /// direction, than the corners.
  void scan(bool up, int side) {
    const double diameter = 2.0 * corners_.max_radius_ + kRounding;
    const int step = up ? 1 : -1;
    sectors_ = {{-kSteepest, kSteepest}};
    int row = static_cast<int>(up ? std::floor(y_) : std::ceil(y_) - 1.0);
    for (; row >= 0 && row < corners_.grid_.rows() && !sectors_.empty(); row += step) {
      if (corners_.stopped_at_step()) return;
      const double near = std::max(0.0, up ? row - y_ : y_ - (row + 1));
      const double far = up ? row + 1 - y_ : y_ - row;
      if (side != 0 && far > diameter) restrict_to_side(side, diameter / far);
      pass_row(row, near, far);
      find_on_line(up ? row + 1 : row, far);
    }
  }

  /// Restricts the sectors to one side, with a margin.
  void restrict_to_side(int side, double margin) {
    for (Sector& sector : sectors_) {
      if (side > 0) {
        sector.left = std::max(sector.left, -margin);
      } else {
        sector.right = std::min(sector.right, margin);
      }
    }
  }

  /// Removes from the sectors what the blocked runs of a row, between `near` and `far` from the viewpoint,
  /// hide.
  void pass_row(int row, double near, double far) {
    sectors_followed_ += static_cast<std::int64_t>(sectors_.size());
    next_sectors_.clear();
    const auto last = corners_.runs_.begin() + corners_.first_run_[row + 1];
    auto first = corners_.runs_.begin() + corners_.first_run_[row];
    // Bounded: the sectors, and the runs of a row, which are between them.
    for (const Sector& sector : sectors_) {
      double open = sector.left;
      const double leftmost = x_ + std::min(sector.left * near, sector.left * far) - kRounding;
      while (first + 1 != last && first->end < leftmost) ++first;
      for (auto run = first; run != last && open <= sector.right; ++run) {
        const double a = run->begin - x_;
        const double b = run->end - x_;
        const double hidden_from = a >= 0.0 ? a / far : (near > 0.0 ? a / near : -kSteepest);
        const double hidden_to = b <= 0.0 ? b / far : (near > 0.0 ? b / near : kSteepest);
        if (hidden_from > sector.right) break;
        keep({open, hidden_from}, far);
        open = std::max(open, hidden_to);
      }
      keep({open, sector.right}, far);
    }
    std::swap(sectors_, next_sectors_);
  }

  void keep(const Sector& sector, double distance) {
    if (sector.left < sector.right && !too_narrow(sector, distance)) next_sectors_.push_back(sector);
  }

  /// Whether the sector at this distance (rows) from the viewpoint is too narrow for any move to a corner in
  /// it, there or farther away.
  ///
  /// The area that the disk covers is convex. So on any grid line between its ends, it covers at least as
  /// much as on the line of one end. There, it covers at least a chord of the disk: 2 r sin(phi) if it moves
  /// at an angle phi to the lines. The line to the corner differs from its direction by at most asin(2 r /
  /// d), where d is its length.
  bool too_narrow(const Sector& sector, double distance) const {
    const double radius = corners_.least_radius_;
    if (distance < kMinRadii * radius) return false;
    const double slope = std::max(std::abs(sector.left), std::abs(sector.right));
    const double chord = 2.0 * radius / std::sqrt(1.0 + slope * slope);
    return (sector.right - sector.left) * distance <
           kWidthMargin * chord * (1.0 - kAsinFactor * 2.0 * radius / distance);
  }

  void find_on_line(int line, double distance) {
    const int last = corners_.first_corner(0, line + 1);
    int next = 0;
    // Bounded: the sectors, and the corners of a line.
    for (const Sector& sector : sectors_) {
      const double leftmost = std::ceil(x_ + sector.left * distance - kRounding);
      if (leftmost > corners_.grid_.columns()) return;
      const double rightmost = x_ + sector.right * distance + kRounding;
      next = std::max(next, corners_.first_corner(static_cast<int>(std::max(0.0, leftmost)), line));
      for (; next != last && corners_.corner(next).x <= rightmost; ++next) found_.push_back(next);
    }
  }

  /// Finds the corners on the grid line of the viewpoint.
  void scan_line(int line) {
    const OccupancyGrid& grid = corners_.grid_;
    const auto open = [&](int column) {
      return !grid.blocked({column, line}) || !grid.blocked({column, line - 1});
    };
    const auto add_corner = [&](int x) {
      const int first = corners_.first_corner(x, line);
      if (first != corners_.first_corner(x + 1, line)) found_.push_back(first);
    };
    for (int column = static_cast<int>(std::floor(x_)); open(column); ++column) add_corner(column + 1);
    for (int column = static_cast<int>(std::ceil(x_)) - 1; open(column); --column) add_corner(column);
  }

  CornerVisibility& corners_;
  double x_;  // in cells
  double y_;
  std::vector<Sector> sectors_;
  std::vector<Sector> next_sectors_;
  std::vector<int> found_;
  std::int64_t sectors_followed_ = 0;
};

CornerVisibility::CornerVisibility(const OccupancyGrid& grid, double least_radius, double max_radius,
                                   const StopCondition& stop)
    : grid_(grid),
      least_radius_(least_radius / grid.resolution()),
      max_radius_(max_radius / grid.resolution()),
      stop_(stop),
      stride_(stop_, kStopStride) {
  find_corners();
  find_blocked_runs();
  if (stopped()) return;
  bends_from_.resize(corners_.size());
}

void CornerVisibility::find_corners() {
  const auto columns = static_cast<std::size_t>(grid_.columns());
  // The rows on both sides of a line, and what is outside the map beside them.
  std::vector<std::uint8_t> below(columns + 2, 1);
  std::vector<std::uint8_t> above(columns + 2, 1);
  std::vector<std::uint8_t> blocked(columns + 1);  // among the four cells around each grid point
  for (int line = 0; line <= grid_.rows() && !stopped_at_step(); ++line) {
    std::swap(below, above);
    if (line < grid_.rows()) {
      const auto row = grid_.row(line);
      std::copy(row.begin(), row.end(), above.begin() + 1);
    } else {
      std::fill(above.begin(), above.end(), std::uint8_t{1});
    }
    for (std::size_t x = 0; x <= columns; ++x) {
      blocked[x] = static_cast<std::uint8_t>(below[x] + below[x + 1] + above[x] + above[x + 1]);
    }
    first_of_line_.push_back(count());
    for_each_equal(blocked, 1, [&](int x) { corners_.push_back(convex_corner(grid_, x, line)); });
  }
  first_of_line_.push_back(count());
}

void CornerVisibility::find_blocked_runs() {
  for (int row = 0; row < grid_.rows() && !stopped_at_step(); ++row) {
    first_run_.push_back(runs_.next_index());
    runs_.push_back({-kFar, 0});
    for (int column = 0; column < grid_.columns(); ++column) {
      if (!grid_.blocked({column, row})) continue;
      if (runs_.back().end == column) {
        ++runs_.back().end;
      } else {
        runs_.push_back({column, column + 1});
      }
    }
    if (runs_.back().end == grid_.columns()) {
      runs_.back().end = kFar;
    } else {
      runs_.push_back({grid_.columns(), kFar});
    }
  }
  first_run_.push_back(runs_.next_index());
}

std::vector<int> CornerVisibility::visible_from(const Position& position) {
  return visible(position.x() / grid_.resolution(), position.y() / grid_.resolution(), nullptr);
}

const std::vector<int>& CornerVisibility::bends_from(int index) {
  auto& known = bends_from_[index];
  if (!known) known = visible(corner(index).x, corner(index).y, &corner(index));
  return *known;
}

std::vector<int> CornerVisibility::visible(double x, double y, const Corner* bend) {
  View view(*this, x, y);
  std::vector<int> corners = view.find(bend);
  work_ += kSectorWork * view.sectors_followed() + static_cast<std::int64_t>(corners.size());
  return corners;
}

int CornerVisibility::first_corner(int x, int line) const {
  if (line > grid_.rows()) return count();
  const auto first = corners_.begin() + first_of_line_[line];
  const auto last = corners_.begin() + first_of_line_[line + 1];
  const auto found = std::lower_bound(first, last, x,
                                      [](const Corner& corner, int abscissa) { return corner.x < abscissa; });
  return static_cast<int>(found - corners_.begin());
}

}  // namespace fleetplan::core
