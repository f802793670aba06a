#pragma once

#include <cstdint>
#include <optional>

#include "api/json/json_reader.h"
#include "api/request/world_frame.h"
#include "core/map/occupancy_grid.h"

namespace fleetplan::api {

/// The map of a request and where it lies in the world.
struct WorldMap {
  core::OccupancyGrid grid;
  WorldFrame frame;
};

/// Reads the member `map`, which has one of `rows`, `occupancy_grid`, `image` and `movingai`: a map of at
/// most `max_cells` cells. Returns none when it has a fault or when the reading of the document is stopped.
std::optional<WorldMap> parse_map(const JsonReader& member, std::int64_t max_cells);

}  // namespace fleetplan::api
