#pragma once

#include <cstddef>

namespace fleetplan {

// The ranges of numbers, wide enough for real fleets. Within them, the planner and its check keep positions
// to far less than a micrometre, whatever the numbers of other robots (docs/checker.md, Tolerances). A number
// outside its range is a fault of the problem. The service accepts the same ranges.

/// The smallest radius, resolution and lattice spacing, metres.
inline constexpr double kShortestLength = 1e-4;
/// The largest map in each direction, and the largest radius, metres.
inline constexpr double kLargestExtent = 1e6;
/// The farthest coordinates from 0, of origins, poses, corners and obstacles, metres.
inline constexpr double kFarthestCoordinate = 1e9;
/// The latest time and the longest duration, seconds: three years.
inline constexpr double kLongestTime = 1e8;

/// The least and greatest linear speeds of robots and in zones, metres per second. Moving obstacles keep to
/// the greatest speed, too.
inline constexpr double kLeastLinearSpeed = 1e-3;
inline constexpr double kMaxLinearSpeed = 1e3;
/// The least and greatest angular speeds, radians per second.
inline constexpr double kLeastAngularSpeed = 1e-3;
inline constexpr double kMaxAngularSpeed = 1e6;
/// The least and greatest accelerations and decelerations, metres (or radians) per second squared.
inline constexpr double kLeastAcceleration = 1e-3;
inline constexpr double kMaxAcceleration = 1e6;
/// The least and greatest weights of robots.
inline constexpr double kLeastWeight = 1e-3;
inline constexpr double kMaxWeight = 1e3;
/// The fewest and most poses of a goal that may be served at one of several.
inline constexpr std::size_t kFewestPoses = 2;
inline constexpr std::size_t kMaxPoses = 100;
/// The shortest horizon, seconds.
inline constexpr double kShortestHorizon = 1e-3;
/// The smallest Zone::half_angle: how far off the heading of a one-way zone moves may be, radians.
inline constexpr double kLeastHalfAngle = 1e-3;

}  // namespace fleetplan
