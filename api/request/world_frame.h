#pragma once

#include "core/geometry/position.h"

namespace fleetplan::api {

/// Where the map lies in the client's world. The core plans in the map frame, whose origin is the lower-left
/// corner of the map; the axes are the same.
struct WorldFrame {
  core::Position origin{0.0, 0.0};  // origin of the map in the world, metres

  core::Position to_map(const core::Position& world) const { return world - origin; }
  core::Position to_world(const core::Position& map) const { return map + origin; }
};

}  // namespace fleetplan::api
