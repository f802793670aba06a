#pragma once

#include <cstddef>
#include <vector>

#include "api/json/json_reader.h"
#include "api/request/world_frame.h"
#include "core/model/robot.h"

namespace fleetplan::api {

/// A robot as far as it could be read. `placed`: its radius and start are valid, so that it can be compared
/// with the map and the other robots, whatever faults it has elsewhere.
struct ReadRobot {
  core::Robot robot;  // in the map frame; `goal` only if it is valid
  bool placed = false;
  JsonReader start;
  JsonReader goal;
};

/// Reads `robots` and `robot_defaults` (may be absent). At most `max_robots`, at least one.
std::vector<ReadRobot> parse_robots(const JsonReader& robots, const JsonReader& defaults,
                                    const WorldFrame& frame, std::size_t max_robots);

}  // namespace fleetplan::api
