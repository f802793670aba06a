#pragma once

#include <limits>

#include "api/json/json_reader.h"

namespace fleetplan::api {

// Lengths, speeds and coordinates beyond a million kilometres or below an atom are mistakes; with these
// bounds no computation of the core overflows.
inline constexpr double kSmallest = 1e-9;
inline constexpr double kLargest = 1e9;
inline constexpr Range kLength{kSmallest, kLargest, "metres"};
inline constexpr Range kLengthOrZero{0.0, kLargest, "metres"};
inline constexpr Range kCoordinate{-kLargest, kLargest, "metres"};
inline constexpr Range kLinearSpeed{kSmallest, kLargest, "metres per second"};
inline constexpr Range kAngularSpeed{kSmallest, kLargest, "radians per second"};
inline constexpr Range kDuration{0.0, kLargest, "seconds"};
inline constexpr Range kAnyAngle{std::numeric_limits<double>::lowest(), std::numeric_limits<double>::max(),
                                 "radians"};

}  // namespace fleetplan::api
