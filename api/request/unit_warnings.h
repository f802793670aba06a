#pragma once

#include <string>
#include <vector>

#include "api/json/json_reader.h"
#include "api/request/parse_robots.h"

namespace fleetplan::api {

/// A heading beyond a turn either way is probably in degrees.
inline constexpr double kUsualHeading = 6.2831853071795865;  // radians
/// Beyond any robot: three turns a second, and 72 km/h.
inline constexpr double kUsualAngularSpeed = 20.0;  // radians per second
inline constexpr double kUsualLinearSpeed = 20.0;   // metres per second

/// Warnings about valid numbers that are probably in other units: headings of starts, goals and one-way
/// zones, and speeds of robots; a sentence for each kind, with the first place and their number. `zones` is
/// the member of the request, or absent. Costs less than reading the request.
std::vector<std::string> unit_warnings(const std::vector<ReadRobot>& robots, const JsonReader& zones);

}  // namespace fleetplan::api
