#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "api/json/fault_list.h"
#include "api/json/json_path.h"
#include "api/json/json_value.h"
#include "api/request/world_frame.h"
#include "core/model/robot.h"

namespace fleetplan::api {

/// A robot as far as it could be read. One with faults elsewhere still has a place: where `placed` says that
/// its radius and start are good, it can be held against the map and the other robots.
struct ReadRobot {
  core::Robot robot;           // in the map frame; `goal` only if it is good
  bool placed = false;         // radius and start are good
  std::uint32_t start_at = 0;  // where the poses are in the document, for the order of faults
  std::uint32_t goal_at = 0;
};

/// Reads `robots` and `robot_defaults` (may be null: not given). At most `max_robots`, at least one.
std::vector<ReadRobot> parse_robots(const JsonValue& robots, const JsonPath& robots_path,
                                    const JsonValue* defaults, const JsonPath& defaults_path,
                                    const WorldFrame& frame, std::size_t max_robots, FaultList& faults);

}  // namespace fleetplan::api
