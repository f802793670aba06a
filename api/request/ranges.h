#pragma once

#include <cstdint>
#include <limits>

#include "api/json/json_reader.h"

namespace fleetplan::api {

// What real fleets stay in. Within these ranges the planner and its check keep positions to far less than a
// micrometre, whatever the numbers of other robots (docs/method.md, Tolerances).
inline constexpr double kShortestLength = 1e-4;     // metres; 200 times the contact tolerance
inline constexpr double kLargestExtent = 1e6;       // metres; of a map, and so of a robot
inline constexpr double kFarthestCoordinate = 1e9;  // metres; doubles are a tenth of a micrometre apart there
inline constexpr double kLongestTime = 1e8;         // seconds, three years
inline constexpr Range kLength{kShortestLength, kLargestExtent, "metres"};
inline constexpr Range kLengthOrZero{0.0, kLargestExtent, "metres"};
inline constexpr Range kCoordinate{-kFarthestCoordinate, kFarthestCoordinate, "metres"};
inline constexpr Range kLinearSpeed{1e-3, 1e3, "metres per second"};
inline constexpr Range kAngularSpeed{1e-3, 1e6, "radians per second"};
inline constexpr Range kDuration{0.0, kLongestTime, "seconds"};
inline constexpr Range kHorizon{1e-3, kLongestTime, "seconds"};
inline constexpr Range kSlackInTime{1e-3, kLongestTime, "seconds"};  // of dependencies
inline constexpr Range kAnyAngle{std::numeric_limits<double>::lowest(), std::numeric_limits<double>::max(),
                                 "radians"};
inline constexpr Range kFraction{0.0, 1.0, ""};  // of an action
/// The number of an action or a goal of a robot; far beyond any limit of a request.
inline constexpr std::uint64_t kGreatestIndex = 1'000'000'000;

}  // namespace fleetplan::api
