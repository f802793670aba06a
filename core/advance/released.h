#pragma once

// Which motion a robot has been released to do, and which it has not.

#include <vector>

#include "core/advance/moment.h"
#include "core/advance/timeline.h"
#include "core/model/action.h"
#include "core/model/robot.h"

namespace fleetplan::core {

/// The motion that a robot has been released to do, and its other motion, on a clock that is 0 at the moment.
struct ReleasedRest {
  Remainder rest;             // to the place that is released
  std::vector<Action> after;  // from there on, at its planned times
};

/// Returns the rest of a robot that has reported how far it is released. It drives there as soon as it can,
/// without the waits that only give way to others.
ReleasedRest released_rest(const Robot& robot, const Execution& execution, const Moment& moment);

}  // namespace fleetplan::core
