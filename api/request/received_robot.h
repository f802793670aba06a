#pragma once

#include <string>
#include <vector>

#include "api/json/faults.h"
#include "api/request/motion/received_motion.h"

namespace fleetplan::api {

/// What the answer needs to know about a robot of the request beside the core's robot.
struct ReceivedRobot {
  ReceivedMotion committed;
  ReceivedMotion previous;
  bool lists_visits = false;  // its plan tells when each goal is visited
  std::vector<Fault> errors;  // why it is invalid; empty if it is not
  /// See parse_metadata: of the robot, and of its goals by their number, as in ReadGoals.
  std::string metadata = {};
  std::vector<std::string> goal_metadata = {};
};

}  // namespace fleetplan::api
