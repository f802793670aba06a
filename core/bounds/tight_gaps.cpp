#include "core/bounds/tight_gaps.h"

#include <algorithm>
#include <cmath>

#include "core/geometry/tolerance.h"

namespace fleetplan::core {
namespace {

/// A gap is tight if a straight move through a third of one cell of it stays on the grid line, up to three
/// times this, in cells, from one end of the map to the other; so both of its ends would be off all cell
/// centres. (The third: a robot may stop in the gap at its own start and goal. With both at the ends of one
/// move, the goal is in sight, and no taut path is needed.)
constexpr double kMaxDeviation = 0.1;
/// The play that contact with the walls leaves to a disk that just fits, metres.
constexpr double kPlay = 8.0 * kSearchSlack;
/// A tangent in a tight gap is so close to a grid line, in cells and radians; far more than the reduction of
/// the disk's radius causes.
constexpr double kOnLine = 1e-3;

/// The width in cells of a gap that is tight for the disk, or 0.
int tight_width(const OccupancyGrid& grid, double radius) {
  const double diameter = 2.0 * radius / grid.resolution();
  if (diameter > std::min(grid.columns(), grid.rows()) + 1.0) return 0;
  const int cells = static_cast<int>(std::lround(diameter));
  if (cells == 0 || cells % 2 != 0) return 0;
  const double play = std::max(0.0, cells - diameter) + kPlay / grid.resolution();
  return play * std::max(grid.columns(), grid.rows()) <= kMaxDeviation ? cells : 0;
}

}  // namespace

TightGaps::TightGaps(const OccupancyGrid& grid, double radius, bool stops_at_cell_centers)
    : grid_(grid), width_(stops_at_cell_centers ? tight_width(grid, radius) : 0) {}

bool TightGaps::crossed_by(const Position& begin, const Position& end, double length) const {
  if (width_ == 0) return false;
  const Position d = end - begin;
  const int axis = std::abs(d.y()) > std::abs(d.x()) ? 1 : 0;
  if (std::abs(d[1 - axis]) > kOnLine * length) return false;
  const Position first = begin / grid_.resolution();
  const Position last = end / grid_.resolution();
  const double line = std::round(last[1 - axis]);
  if (std::abs(last[1 - axis] - line) > kOnLine) return false;
  const auto [low, high] = std::minmax(first[axis], last[axis]);
  const int end_cell = static_cast<int>(std::floor(high + kOnLine));
  for (int cell = static_cast<int>(std::ceil(low - kOnLine)); cell < end_cell; ++cell) {
    if (is_gap(static_cast<int>(line), cell, axis == 1)) return true;
  }
  return false;
}

/// Whether there are walls on both sides of the grid line, exactly a tight gap apart.
bool TightGaps::is_gap(int line, int cell, bool vertical) const {
  const int low = line - width_ / 2 - 1;
  const int high = line + width_ / 2;
  return vertical ? grid_.blocked({low, cell}) && grid_.blocked({high, cell})
                  : grid_.blocked({cell, low}) && grid_.blocked({cell, high});
}

}  // namespace fleetplan::core
