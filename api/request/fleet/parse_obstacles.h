#pragma once

#include <vector>

#include "api/json/json_reader.h"
#include "api/request/limits.h"
#include "api/request/shared_members.h"
#include "api/request/world_frame.h"
#include "core/geometry/moving_obstacle.h"

namespace fleetplan::api {

/// Reads `obstacles` (may be absent), in the map frame. Motion before t = 0 is cut off, and an obstacle that
/// is gone by then is left out. `ids` has those of the robots.
std::vector<core::MovingObstacle> parse_obstacles(const JsonReader& member, const WorldFrame& frame,
                                                  const Limits& limits, UniqueIds& ids);

}  // namespace fleetplan::api
