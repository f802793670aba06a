#pragma once

#include <vector>

#include "core/geometry/position.h"
#include "core/runtime/stop_condition.h"
#include "core/verify/geometry/segment_to_rectangle.h"

namespace fleetplan::core {

/// Whether a point is inside of a simple polygon, by its winding number. Either answer is possible within
/// rounding of the border.
bool is_inside(const std::vector<Position>& corners, const Position& point);

/// Whether a point is inside and farther than `depth` metres from the border.
bool is_deep_inside(const std::vector<Position>& corners, const Position& point, double depth);

/// The distance between a segment (or a point, if `from` == `to`) and a simple polygon with its inside. The
/// fraction is that of the first point of the segment that is nearest; if the segment enters the polygon, of
/// the first one inside.
NearestPoint nearest_to_polygon(const Position& from, const Position& to,
                                const std::vector<Position>& corners);

/// The stretches of a segment, of length > 0, whose quarter points are inside of the polygon and not all
/// within `depth` metres of its border; ascending. Only the first ones once `stop` is met.
std::vector<Stretch> stretches_inside(const Position& from, const Position& to,
                                      const std::vector<Position>& corners, double depth,
                                      const StopCondition& stop);

}  // namespace fleetplan::core
