#pragma once

#include <cstddef>

namespace fleetplan::core {

/// A robot has at most so many meetings in a plan, the first ones. If it has so many, later collisions of
/// what it certainly does are exempt, too. So the list grows with the robots only.
inline constexpr std::size_t kMostMeetingsOfRobot = 8;

}  // namespace fleetplan::core
