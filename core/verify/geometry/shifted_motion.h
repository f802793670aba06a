#pragma once

// Two bodies at slightly different times.

#include "core/verify/execution/execution.h"
#include "core/verify/geometry/relative_motion.h"

namespace fleetplan::core {

/// Where two bodies come nearest to each other.
struct ShiftedMoment {
  double distance = 0.0;  // metres; infinity if there is no such pair of times
  double t_first = 0.0;
  double t_second = 0.0;
};

/// The least distance of a position of one leg at a time within `first`, and one of the other leg at a time
/// within `second`, if these times differ by no more than `margin`. All times are finite. Exact up to
/// rounding.
ShiftedMoment least_shifted_distance(const Leg& a, const TimeSpan& first, const Leg& b,
                                     const TimeSpan& second, double margin);

}  // namespace fleetplan::core
