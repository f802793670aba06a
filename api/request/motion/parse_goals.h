#pragma once

#include <optional>
#include <string>
#include <vector>

#include "api/json/json_reader.h"
#include "api/request/motion/quota.h"
#include "api/request/world_frame.h"
#include "core/model/robot.h"

namespace fleetplan::api {

/// The goals of a robot that are valid, in their order, in the map frame.
struct ReadGoals {
  std::vector<core::Goal> goals;
  std::vector<JsonReader> places;  // of each of them
  /// Given as a list, or with a service, a radius or metadata: the answer tells when each is visited.
  bool lists_visits = false;
  std::vector<std::string> metadata;  // of each, see parse_metadata; shorter if the last ones have none
};

/// Reads `x`, `y` and `theta` (optional) of a pose whose members are known. Nothing when one has a fault.
std::optional<core::Goal> parse_pose(const JsonReader& pose, const WorldFrame& frame);

/// Reads `goal` or `goals` of a robot. Without both, or with an empty list, there are none. `quota`: of
/// goals.
ReadGoals parse_goals(const JsonReader& robot, const WorldFrame& frame, Quota& quota);

}  // namespace fleetplan::api
