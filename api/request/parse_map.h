#pragma once

#include <cstdint>
#include <optional>

#include "api/json/fault_list.h"
#include "api/json/json_path.h"
#include "api/json/json_value.h"
#include "api/request/world_frame.h"
#include "core/map/occupancy_grid.h"

namespace fleetplan::api {

/// The map of a request and where it lies in the world.
struct WorldMap {
  core::OccupancyGrid grid;
  WorldFrame frame;
};

/// Reads the member `map`: rows from the top, `.` and `G` free, `#`, `@`, `O`, `T`, `W` blocked, at most
/// `max_cells` of them. Nothing, and faults, when it is no map.
std::optional<WorldMap> parse_map(const JsonValue& value, const JsonPath& path, std::int64_t max_cells,
                                  FaultList& faults);

}  // namespace fleetplan::api
