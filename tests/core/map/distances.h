#pragma once

// Distances from obstacles by brute force, to compare with.

#include <algorithm>
#include <cmath>

#include "core/geometry/position.h"
#include "core/geometry/segment.h"
#include "core/map/occupancy_grid.h"

namespace fleetplan::core {

inline double point_to_segment(const Position& p, const Position& a, const Position& b) {
  const Position d = b - a;
  const double f = d.squaredNorm() > 0.0 ? std::clamp((p - a).dot(d) / d.squaredNorm(), 0.0, 1.0) : 0.0;
  return (a + f * d - p).norm();
}

/// Returns whether the segment meets the closed rectangle. Clips it against the four sides.
inline bool meets(const Position& a, const Position& b, const Position& low, const Position& high) {
  double first = 0.0;
  double last = 1.0;
  for (int axis = 0; axis < 2; ++axis) {
    const double d = b[axis] - a[axis];
    if (d == 0.0 && (a[axis] < low[axis] || a[axis] > high[axis])) return false;
    if (d == 0.0) continue;
    const double f = (low[axis] - a[axis]) / d;
    const double g = (high[axis] - a[axis]) / d;
    first = std::max(first, std::min(f, g));
    last = std::min(last, std::max(f, g));
  }
  return first <= last;
}

inline double segment_to_rectangle(const Position& a, const Position& b, const Position& low,
                                   const Position& high) {
  if (meets(a, b, low, high)) return 0.0;
  const auto end = [&](const Position& p) {
    return std::hypot(std::max({low.x() - p.x(), p.x() - high.x(), 0.0}),
                      std::max({low.y() - p.y(), p.y() - high.y(), 0.0}));
  };
  return std::min({end(a), end(b), point_to_segment(low, a, b), point_to_segment(high, a, b),
                   point_to_segment({low.x(), high.y()}, a, b), point_to_segment({high.x(), low.y()}, a, b)});
}

/// From the segment to the nearest blocked point, the map's edge included; negative outside the map.
inline double obstacle_distance_of(const OccupancyGrid& grid, const Position& a, const Position& b) {
  double nearest = kForever;
  for (const Position& p : {a, b}) {
    nearest = std::min({nearest, p.x(), p.y(), grid.width() - p.x(), grid.height() - p.y()});
  }
  const double size = grid.resolution();
  const auto [left, right] = std::minmax({a.x(), b.x()});
  const auto [bottom, top] = std::minmax({a.y(), b.y()});
  for (int row = 0; row < grid.rows(); ++row) {
    if (row * size - top >= nearest || bottom - (row + 1) * size >= nearest) continue;
    for (int column = 0; column < grid.columns(); ++column) {
      if (!grid.blocked({column, row})) continue;
      if (column * size - right >= nearest || left - (column + 1) * size >= nearest) continue;
      const Position low(column * size, row * size);
      nearest = std::min(nearest, segment_to_rectangle(a, b, low, low + Position(size, size)));
    }
  }
  return nearest;
}

}  // namespace fleetplan::core
