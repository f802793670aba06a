#pragma once

#include <optional>
#include <vector>

#include "api/json/json_reader.h"
#include "api/request/motion/received_motion.h"
#include "api/request/world_frame.h"
#include "core/model/action.h"
#include "core/model/robot.h"

namespace fleetplan::api {

/// Reads one action, in the world and with its headings as given. Where it has a fault, the value is 0.
core::Action parse_action(const JsonReader& item, const Range& times);

/// The same action in the map frame, with normalised headings.
core::Action to_map(const core::Action& world, const WorldFrame& frame);

/// What is known of the robot that executes actions; what could not be read is not compared.
struct ActionsOwner {
  std::optional<core::Pose> start;      // in the map frame
  std::optional<double> linear_speed;   // metres per second
  std::optional<double> angular_speed;  // radians per second
  std::optional<bool> may_reverse = {};
};

/// The actions of a robot from t = 0 in its start. Each begins exactly when and where the one before ends.
struct ReadActions {
  std::vector<core::Action> actions;  // in the map frame
  ReceivedMotion received;
};

/// Reads `committed` or `previous` of a robot. Actions that are not contiguous in time and space, contradict
/// their types or are faster than the robot are faults; then there are none.
std::optional<ReadActions> parse_actions(const JsonReader& list, const ActionsOwner& owner,
                                         const WorldFrame& frame);

}  // namespace fleetplan::api
