#pragma once

#include <vector>

#include "api/json/json_reader.h"
#include "api/request/limits.h"
#include "api/request/parse_robots.h"
#include "api/request/world_frame.h"
#include "core/model/zone.h"

namespace fleetplan::api {

/// Reads `zones` (may be absent), in the map frame; those with a fault are left out. Robots are indices into
/// `robots`.
std::vector<core::Zone> parse_zones(const JsonReader& member, const WorldFrame& frame, const Limits& limits,
                                    const std::vector<ReadRobot>& robots);

}  // namespace fleetplan::api
