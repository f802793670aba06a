#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "api/json/json_reader.h"
#include "api/request/map/raster.h"
#include "api/request/world_frame.h"

namespace fleetplan::api {

/// Ends the fault of a map that is turned.
inline constexpr std::string_view kTurnRemedy =
    "; turn the image, or give 0 and all poses in the frame of the image";

/// What a message of the type nav_msgs/OccupancyGrid says.
struct OccupancyMessage {
  Raster raster;
  double resolution = 0.0;  // metres
  WorldFrame frame;
};

/// Reads it from JSON as rosbridge and `ros2 topic echo` write it; times and the header are ignored. Nothing
/// when it has a fault or when the reading of the document is stopped.
std::optional<OccupancyMessage> parse_occupancy_message(const JsonReader& message, std::int64_t max_cells);

}  // namespace fleetplan::api
