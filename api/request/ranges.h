#pragma once

#include <fleetplan/limits.h>

#include <cstdint>
#include <limits>

#include "api/json/json_reader.h"

namespace fleetplan::api {

// The ranges of numbers in requests are those of the library.
inline constexpr Range kLength{kShortestLength, kLargestExtent, "metres"};
inline constexpr Range kLengthOrZero{0.0, kLargestExtent, "metres"};
inline constexpr Range kCoordinate{-kFarthestCoordinate, kFarthestCoordinate, "metres"};
inline constexpr Range kLinearSpeed{kLeastLinearSpeed, kMostLinearSpeed, "metres per second"};
inline constexpr Range kAngularSpeed{kLeastAngularSpeed, kMostAngularSpeed, "radians per second"};
inline constexpr Range kLinearAcceleration{kLeastAcceleration, kMostAcceleration,
                                           "metres per second squared"};
inline constexpr Range kAngularAcceleration{kLeastAcceleration, kMostAcceleration,
                                            "radians per second squared"};
/// Backwards, a robot has a negative speed.
inline constexpr Range kMeasuredSpeed{-kMostLinearSpeed, kMostLinearSpeed, "metres per second"};
/// Of a profile of speed.
inline constexpr Range kProfileSpeed{0.0, kMostAngularSpeed, "metres or radians per second"};
inline constexpr Range kDuration{0.0, kLongestTime, "seconds"};
inline constexpr Range kDue{-kLongestTime, kLongestTime, "seconds"};  // negative: the past
inline constexpr Range kHorizon{kShortestHorizon, kLongestTime, "seconds"};
inline constexpr Range kSlackInTime{1e-3, kLongestTime, "seconds"};  // slack of dependencies
inline constexpr Range kAnyAngle{std::numeric_limits<double>::lowest(), std::numeric_limits<double>::max(),
                                 "radians"};
inline constexpr Range kWeight{kLeastWeight, kMostWeight, ""};  // of robots and tasks
inline constexpr Range kFraction{0.0, 1.0, ""};                 // fraction of an action
/// The greatest number of an action or a goal of a robot; far beyond any limit of a request.
inline constexpr std::uint64_t kGreatestIndex = 1'000'000'000;

}  // namespace fleetplan::api
