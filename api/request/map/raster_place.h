#pragma once

// The position of rasters in the world. Maps and masks of ROS have an origin with a yaw.

#include <optional>

#include "api/json/json_reader.h"
#include "core/geometry/position.h"
#include "core/map/occupancy_grid.h"

namespace fleetplan::api {

/// The pose of the lower-left corner of a raster, which is the centre of its rotation.
struct RasterPose {
  core::Position corner{0.0, 0.0};  // in the world, metres
  int quarter_turns = 0;            // counter-clockwise, 0 to 3

  /// Returns the point at `offset` from the corner of a raster that is not turned, after the turn.
  core::Position turned(const core::Position& offset) const;
};

/// Returns the cell of the turned raster for a cell of a raster of this size.
core::Cell turned_cell(const core::Cell& cell, int columns, int rows, int quarter_turns);

/// Returns the least coordinates of a raster of this size, metres, in the world.
core::Position lower_left_of(const RasterPose& pose, double width, double height);

/// Reads `origin` of a map.yaml: the list of x, y and yaw. None if it is absent or has a fault.
std::optional<RasterPose> parse_yaml_origin(const JsonReader& member);

/// Reads the origin of a message, a geometry_msgs/Pose. An orientation of all 0, as in a message that was
/// never filled, is no turn.
RasterPose parse_message_origin(const JsonReader& member);

}  // namespace fleetplan::api
