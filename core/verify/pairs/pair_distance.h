#pragma once

#include <optional>
#include <vector>

#include "core/verify/execution/execution.h"
#include "core/verify/geometry/relative_motion.h"

namespace fleetplan::core {

/// The least distance between the centres of two bodies within a time span, metres; infinity if they are
/// never there together.
double least_distance(const std::vector<Leg>& a, const std::vector<Leg>& b, const TimeSpan& span);

/// The uninterrupted time around `t` in which two bodies are nearer to each other than `distance`; none if
/// they are not at `t`.
std::optional<TimeSpan> time_together(const std::vector<Leg>& a, const std::vector<Leg>& b, double distance,
                                      double t);

}  // namespace fleetplan::core
