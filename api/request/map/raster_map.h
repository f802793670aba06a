#pragma once

#include <cstdint>
#include <optional>

#include "api/json/json_reader.h"
#include "api/request/map/map_frame.h"

namespace fleetplan::api {

// Maps of occupancy, as ROS has them: cells of 65 % and more are blocked, of up to 25 % free, and the others
// unknown, which are `unknown` of the map: "blocked" (the default) or "free". At most `max_cells` cells.
// Nothing when they have a fault or when the reading of the document is stopped.

/// A map with the member `occupancy_grid`: a message of the type nav_msgs/OccupancyGrid.
std::optional<WorldMap> parse_occupancy_grid_map(const JsonReader& map, std::int64_t max_cells);

/// A map with the member `image`: an image and the members of its map.yaml.
std::optional<WorldMap> parse_image_map(const JsonReader& map, std::int64_t max_cells);

}  // namespace fleetplan::api
