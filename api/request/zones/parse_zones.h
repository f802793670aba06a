#pragma once

#include <vector>

#include "api/json/json_reader.h"
#include "api/request/fleet/parse_robots.h"
#include "api/request/limits.h"
#include "api/request/map/parse_map.h"
#include "core/model/zone.h"

namespace fleetplan::api {

/// The robots that zones may name: those of the request, or also others, which are not there.
enum class ZoneRobots { of_request, also_others };

/// Reads `zones` (may be absent), in the frame of the map; those with a fault are left out. Their robots are
/// indices into `robots`; one that is not there has the first index that is none. A mask becomes several
/// zones of one id, which follow each other. Without a map (null), masks are not read.
std::vector<core::Zone> parse_zones(const JsonReader& member, const WorldMap* map, const Limits& limits,
                                    const std::vector<ParsedRobot>& robots,
                                    ZoneRobots named = ZoneRobots::of_request);

}  // namespace fleetplan::api
