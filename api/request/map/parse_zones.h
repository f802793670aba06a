#pragma once

// Zones of requests. Their shapes are polygons, or masks, which are images of the map.

#include <cstdint>
#include <vector>

#include "api/json/json_reader.h"
#include "api/request/fleet/parse_robots.h"
#include "api/request/limits.h"
#include "api/request/map/parse_map.h"
#include "api/request/shared_members.h"
#include "core/geometry/position.h"
#include "core/map/occupancy_grid.h"
#include "core/model/surroundings.h"

namespace fleetplan::api {

/// Reads the corners of a simple polygon, in the map frame. Fewer than three, one that equals the one before
/// and borders that meet elsewhere than at their common corner are faults; then none are returned. All
/// polygons together take their corners from the quota.
std::vector<core::Position> parse_polygon(const JsonReader& member, const WorldFrame& frame, Quota& corners);

/// Cells of a mask that have the same value, as a rectangle in the map frame.
struct MaskPart {
  std::int8_t percent = 0;
  std::vector<core::Position> polygon;
};

/// Reads `mask`: an image of the size of the map, a pixel for each cell. With `by_percent`, the parts are the
/// cells from 1 to 100 %; otherwise those that are occupied by the thresholds of map_server, as 100 %. Parts
/// overlap by far less than a cell, so that nothing lies between them. Returns none when it has a fault. All
/// parts of a request take their corners from the quota.
std::vector<MaskPart> parse_mask(const JsonReader& member, const core::OccupancyGrid& map, bool by_percent,
                                 Quota& corners);

/// The robots that zones may name: those of the request, or also others, which are not there.
enum class ZoneRobots { of_request, also_others };

/// Reads `zones` (may be absent), in the frame of the map; those with a fault are left out. Their robots are
/// indices into `robots`; one that is not there has the first index that is none. A mask becomes several
/// zones of one id, which follow each other. Without a map (null), masks are not read.
std::vector<core::Zone> parse_zones(const JsonReader& member, const WorldMap* map, const Limits& limits,
                                    const std::vector<ParsedRobot>& robots,
                                    ZoneRobots named = ZoneRobots::of_request);

}  // namespace fleetplan::api
