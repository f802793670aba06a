#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "api/json/json_reader.h"
#include "api/request/limits.h"
#include "api/request/motion/received_motion.h"
#include "api/request/motion/unique_ids.h"
#include "api/request/world_frame.h"
#include "core/model/robot.h"

namespace fleetplan::api {

/// A robot as far as it could be read. `placed`: its radius and start are valid, so that it can be compared
/// with the map and the other robots, whatever faults it has elsewhere.
struct ReadRobot {
  core::Robot robot;  // in the map frame; goals and actions only if they are valid
  bool placed = false;
  JsonReader start;
  std::vector<JsonReader> goals;  // of each goal of the robot
  JsonReader committed;
  ReceivedMotion received_committed;
  ReceivedMotion received_previous;
  bool lists_visits = false;               // see ReadGoals
  std::vector<std::string> goal_metadata;  // see ReadGoals
  std::string metadata;                    // see parse_metadata
  std::optional<double> execution_margin;  // metres
  std::optional<double> body_radius = {};  // metres: of the robot itself, if it is planned with another one
};

/// Reads `robots` and `robot_defaults` (may be absent): at least one, and not more than the limits allow, nor
/// more goals and actions. `ids` gets those of the robots.
std::vector<ReadRobot> parse_robots(const JsonReader& robots, const JsonReader& defaults,
                                    const WorldFrame& frame, const Limits& limits, UniqueIds& ids);

}  // namespace fleetplan::api
