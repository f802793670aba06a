#pragma once

// What a single request may ask for: the number or size of each thing, and the ranges of numbers.

#include <fleetplan/limits.h>

#include <cstddef>
#include <cstdint>
#include <limits>

#include "api/json/json_reader.h"

namespace fleetplan::api {

/// What a single request may ask for. The defaults are the service's.
struct Limits {
  std::size_t max_body = 32u << 20;     // bytes, after decompression
  std::int64_t max_cells = 16'000'000;  // cells of the map
  std::size_t max_robots = 2000;
  // In total, wherever they are:
  std::size_t max_goals = 20'000;     // goals in lists `goals`
  std::size_t max_actions = 200'000;  // actions in `committed` and `previous`
  std::size_t max_obstacles = 2000;
  std::size_t max_obstacle_entries = 400'000;
  std::size_t max_zones = 1000;
  std::size_t max_zone_corners = 20'000;     // corners of polygons of zones
  std::size_t max_plan_memory = 256u << 20;  // bytes, for all that is made of a body
  int max_depth = 32;                        // nesting of the JSON
  std::int64_t default_budget_ms = 5000;     // budget of a request that names none
  std::int64_t max_budget_ms = 120'000;      // a longer one is clamped, with a warning
};

/// The most pairs of poses of one matrix, and of robots and tasks of one assignment.
inline constexpr std::size_t kMaxPairs = 250'000;

// The ranges of numbers in requests equal the library's ranges.
inline constexpr Range kLength{kShortestLength, kLargestExtent, "metres"};
inline constexpr Range kLengthOrZero{0.0, kLargestExtent, "metres"};
inline constexpr Range kCoordinate{-kFarthestCoordinate, kFarthestCoordinate, "metres"};
inline constexpr Range kLinearSpeed{kLeastLinearSpeed, kMaxLinearSpeed, "metres per second"};
inline constexpr Range kAngularSpeed{kLeastAngularSpeed, kMaxAngularSpeed, "radians per second"};
inline constexpr Range kLinearAcceleration{kLeastAcceleration, kMaxAcceleration, "metres per second squared"};
inline constexpr Range kAngularAcceleration{kLeastAcceleration, kMaxAcceleration,
                                            "radians per second squared"};
/// The measured speed of a robot; negative backwards.
inline constexpr Range kMeasuredSpeed{-kMaxLinearSpeed, kMaxLinearSpeed, "metres per second"};
/// The speeds in a profile of speed.
inline constexpr Range kProfileSpeed{0.0, kMaxAngularSpeed, "metres or radians per second"};
inline constexpr Range kDuration{0.0, kLongestTime, "seconds"};
inline constexpr Range kDue{-kLongestTime, kLongestTime, "seconds"};  // negative: the past
inline constexpr Range kHorizon{kShortestHorizon, kLongestTime, "seconds"};
inline constexpr Range kSlackInTime{1e-3, kLongestTime, "seconds"};  // slack of dependencies
inline constexpr Range kAnyAngle{std::numeric_limits<double>::lowest(), std::numeric_limits<double>::max(),
                                 "radians"};
inline constexpr Range kWeight{kLeastWeight, kMaxWeight, ""};  // of robots and tasks
inline constexpr Range kFraction{0.0, 1.0, ""};                // fraction of an action
/// The greatest number of an action or a goal of a robot. Far beyond any limit of a request.
inline constexpr std::uint64_t kGreatestIndex = 1'000'000'000;

}  // namespace fleetplan::api
