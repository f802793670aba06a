#pragma once

#include <vector>

#include "api/json/json_reader.h"
#include "api/request/motion/quota.h"
#include "api/request/world_frame.h"
#include "core/geometry/position.h"

namespace fleetplan::api {

/// Reads the corners of a simple polygon, in the map frame. Fewer than three, one that equals the one before
/// and borders that meet elsewhere than at their common corner are faults; then there is none. All polygons
/// together take their corners from the quota.
std::vector<core::Position> parse_polygon(const JsonReader& member, const WorldFrame& frame, Quota& corners);

}  // namespace fleetplan::api
