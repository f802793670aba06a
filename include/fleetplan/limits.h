#pragma once

namespace fleetplan {

// What real fleets stay in. Within these ranges the planner and its check keep positions to far less than a
// micrometre, whatever the numbers of other robots (docs/method.md, Tolerances). A number outside of its
// range is a fault of the problem. The service accepts the same ranges.

/// Metres: the smallest radius, resolution and lattice spacing.
inline constexpr double kShortestLength = 1e-4;
/// Metres: the largest map in each direction, and the largest radius.
inline constexpr double kLargestExtent = 1e6;
/// Metres: the farthest coordinates from 0, of origins, poses, corners and obstacles.
inline constexpr double kFarthestCoordinate = 1e9;
/// Seconds, three years: the latest time and the longest duration.
inline constexpr double kLongestTime = 1e8;

/// Metres per second: speeds of robots and in zones; moving obstacles are not faster.
inline constexpr double kLeastLinearSpeed = 1e-3;
inline constexpr double kMostLinearSpeed = 1e3;
/// Radians per second.
inline constexpr double kLeastAngularSpeed = 1e-3;
inline constexpr double kMostAngularSpeed = 1e6;
/// Seconds: the shortest horizon.
inline constexpr double kShortestHorizon = 1e-3;
/// Radians: how far from its heading a one-way zone lets robots move, at least.
inline constexpr double kLeastHalfAngle = 1e-3;

}  // namespace fleetplan
