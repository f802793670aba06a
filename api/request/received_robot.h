#pragma once

#include <vector>

#include "api/json/fault.h"
#include "api/request/motion/received_motion.h"

namespace fleetplan::api {

/// What the answer needs to know about a robot of the request beside the core's robot.
struct ReceivedRobot {
  ReceivedMotion committed;
  ReceivedMotion previous;
  bool lists_visits = false;  // its plan tells when each goal is visited
  std::vector<Fault> errors;  // why it is invalid; empty if it is not
};

}  // namespace fleetplan::api
