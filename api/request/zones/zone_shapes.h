#pragma once

// The shapes of zones: polygons, and masks, which are images of the map.

#include <cstdint>
#include <vector>

#include "api/json/json_reader.h"
#include "api/request/shared_members.h"
#include "api/request/world_frame.h"
#include "core/geometry/position.h"
#include "core/map/occupancy_grid.h"

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

}  // namespace fleetplan::api
