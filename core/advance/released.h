#pragma once

// What a robot may do already, and what it may not do yet.

#include <vector>

#include "core/advance/moment.h"
#include "core/advance/timeline.h"
#include "core/model/action.h"
#include "core/model/robot.h"

namespace fleetplan::core {

/// What a robot may do already, and what it may not do yet, on a clock that is 0 at the moment.
struct ReleasedRest {
  Remainder rest;             // to the place that is released
  std::vector<Action> after;  // from there on, at its planned times
};

/// Returns the rest of a robot that has reported how far it is released. It goes there as soon as it can,
/// without the waits that only give way to others.
ReleasedRest released_rest(const Robot& robot, const Execution& execution, const Moment& moment);

}  // namespace fleetplan::core
